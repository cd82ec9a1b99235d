#!/usr/bin/env bash
# Makes the pictures of the README with the program itself: tools/make_pictures.sh [PERCALE]
# The picture of the viewer needs Xvfb, xdotool and ImageMagick's import.
set -euo pipefail
cd -P -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
percale=${1:-build/release/bin/percale}
out=docs/pictures
mkdir -p $out

shot() { # NAME ARGUMENTS
  local name=$1
  shift
  "$percale" shot "$@" --shader-defaults --size 480x384 --samples 8 -o "$out/$name.png"
}
shot pinned2 scene/pinned2.json --until-rest --shader Wireframe --camera 25,10,1.7 --target .5,.45,.3
shot sphere scene/sphere.json --until-rest --shader Phong --set look.color=[.85,.35,.3] --camera 25,18,1.5 --target .5,.15,.5
shot fold scene/selfCollision.json --frame 45 --shader Fabric --set look.color=[.42,.66,.64] --camera 35,20,1.3 --target .5,.25,0
shot flag scene/flag.json --frame 150 --camera 20,8,2.4 --target .65,.45,0
shot hammock scene/hammock.json --frame 300 --camera 35,24,2 --target 0,.6,.6
shot cobbles scene/cobbles.json --frame 400 --camera -30,35,1.8 --target .5,.1,.5

# The viewer, running, in a window of its own on a display of its own.
exec 3< <(exec Xvfb -displayfd 1 -screen 0 1280x1024x24 2>/dev/null)
read -r display <&3
trap 'kill $(jobs -p) 2>/dev/null || true; pkill -f "Xvfb -displayfd 1 -screen 0 1280x1024x24" || true' EXIT
export DISPLAY=:$display
log=$(mktemp)
"$percale" view scene/sphere.json --fresh --shader-defaults --shader Bump --log "$log" &
viewer=$!
until grep -q '"widget"' "$log"; do sleep 0.2; done
window=$(xdotool search --onlyvisible --pid $viewer | head -n 1)
xdotool windowfocus "$window" key --window "$window" p
sleep 8
import -window "$window" "$out/viewer.png"
xdotool key --window "$window" Escape
wait $viewer
rm -f "$log"
