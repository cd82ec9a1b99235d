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
shot flag scene/flag.json --frame 150 --camera 20,8,2.4 --target .65,.45,0
shot hammock scene/hammock.json --frame 300 --camera 35,24,2 --target 0,.6,.6
shot cobbles scene/cobbles.json --frame 400 --camera -30,35,1.8 --target .5,.1,.5

# The gauntlet, at the frame where it is worst: docs/gauntlet.md.
worst() { # NAME FRAME [ARGUMENTS]
  local name=$1 frame=$2
  shift 2
  "$percale" shot "scene/gauntlet/$name.json" --frame "$frame" --shader-defaults --size 400x320 --samples 8 "$@" \
    -o "$out/gauntlet_$name.png"
}
worst ball 34 --camera 70,14,3.6 --target 0,.8,1
worst funnel 105
worst garment 132
worst knot 90
worst layers50 30 --camera 30,14,1.6 --target .2,.25,.2
worst needles 150 --camera 30,24,1.7 --target .5,.35,.5
worst spin 220 --camera 30,24,1.9 --target .5,.4,.5
worst squeeze 70
worst tablecloth 75 --camera 25,24,2.6 --target .7,.4,.5
worst tangled 0
worst twist 150

# Short films that browsers play: film NAME SCENE ARGUMENTS.
film() {
  local name=$1 folder
  shift
  folder=$(mktemp -d)
  "$percale" render "$@" --shader-defaults --fps 20 --size 480x384 --samples 8 -o "$folder/film" --progress none
  ffmpeg -y -loglevel error -framerate 20 -i "$folder/film/%04d.png" -loop 0 -c:v libwebp_anim -quality 75 "$out/$name.webp"
  rm -rf "$folder"
}
film drape scene/sphere.json --shader Fabric --set look.color=[.85,.35,.3] --seconds 2.4 --camera 30,22,2.1 --target .5,.4,.5
film knot scene/gauntlet/knot.json --seconds 2
film twist scene/gauntlet/twist.json --seconds 6
film garment scene/gauntlet/garment.json --seconds 3

# The viewer, running, in a window of its own on a display of its own.
exec 3< <(exec Xvfb -displayfd 1 -screen 0 1280x1024x24 2>/dev/null)
read -r display <&3
trap 'kill $(jobs -p) 2>/dev/null || true; pkill -f "Xvfb -displayfd 1 -screen 0 1280x1024x24" || true' EXIT
export DISPLAY=:$display
log=$(mktemp)
"$percale" view scene/sphere.json --fresh --shader-defaults --shader Fabric --set look.color=[.85,.35,.3] --log "$log" &
viewer=$!
until grep -q '"widget"' "$log"; do sleep 0.2; done
window=$(xdotool search --onlyvisible --pid $viewer | head -n 1)
xdotool windowfocus "$window" key --window "$window" p
sleep 8
import -window "$window" "$out/viewer.png"
xdotool key --window "$window" Escape
wait $viewer
rm -f "$log"
