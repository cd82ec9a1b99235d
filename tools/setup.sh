# shellcheck shell=bash disable=SC2154,SC2016
# What ./run and ./test share: installing missing packages and building. To be sourced by bash
# (3.2 will do, macOS has no newer one) with `root` set to the project's folder.

# The one list of packages (Debian's names): name | needed by | what for.
# `run`: ./run and ./test. `test`: ./test alone. `video`: wanted by ./run, but it can do without.
percale_packages() {
  cat <<'LIST'
g++|run|the C++ compiler
cmake|run|sets the build up
ninja-build|run|runs the build
libtbb-dev|run|threads
libeigen3-dev|run|sparse direct solves, for the reference that the fabric solver is held against
nlohmann-json3-dev|run|reads scene files
libcli11-dev|run|reads the command line
libpng-dev|run|reads and writes pictures
libepoxy-dev|run|finds the functions of OpenGL
libegl-dev|run|OpenGL without a display
libegl1|run|OpenGL without a display
libgl1|run|OpenGL
libgl1-mesa-dri|run|OpenGL on any machine, by the processor if need be
libglfw3-dev|run|the viewer's window
libimgui-dev|run|the viewer's panels
ffmpeg|video|writes videos
doctest-dev|test|the test framework
python3|test|drives the program in tests
xvfb|test|a display for tests of the window
xdotool|test|keys and mouse for tests of the window
glslang-tools|test|compiles the shaders as a browser does
LIST
}

say() { printf 'percale: %s\n' "$*" >&2; }

# missing_packages KIND...: those of these kinds that are not installed, one line each as in the list.
missing_packages() {
  local name kind why kinds=" $* " known
  known=$(percale_packages | cut -d'|' -f1 | xargs dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null || true)
  percale_packages | while IFS='|' read -r name kind why; do
    case $kinds in *" $kind "*) ;; *) continue ;; esac
    case $'\n'$known$'\n' in *$'\n'"$name installed"$'\n'*) ;; *) echo "$name|$kind|$why" ;; esac
  done
}

# ensure_packages KIND...: installs what is missing, or says what to do and ends the script.
ensure_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    ensure_tools "$@"
    return
  fi
  local missing names name kind why as_root=() needed=no
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  names=$(cut -d'|' -f1 <<<"$missing" | tr '\n' ' ')
  names=${names% }
  while IFS='|' read -r name kind why; do
    [ "$kind" = video ] || needed=yes
  done <<<"$missing"

  if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
      as_root=(sudo)
    elif [ $needed = no ]; then
      [ -f "$root/build/release/build.ninja" ] || say "$names is not installed: videos become numbered pictures"
      return 0
    else
      say "these packages are missing, and installing them takes root or sudo:"
      list_packages <<<"$missing"
      say "ask for, or run as root:  apt-get install --no-install-recommends $names"
      exit 1
    fi
  fi

  say "installing these Debian packages, which are missing${as_root[0]:+ (with sudo)}:"
  list_packages <<<"$missing"
  local log
  log=$(mktemp)
  # shellcheck disable=SC2086
  if ! apt_install $names >"$log" 2>&1; then
    # The lists of packages are missing or out of date.
    say "fetching the lists of packages (apt-get update)"
    if ! { "${as_root[@]+"${as_root[@]}"}" apt-get -q update && apt_install $names; } >>"$log" 2>&1; then
      grep -E '^[EW]: ' "$log" | head -n 10 >&2 || tail -n 10 "$log" >&2
      rm -f "$log"
      if [ $needed = no ]; then
        say "$names could not be installed: videos become numbered pictures"
        return 0
      fi
      say "the packages could not be installed (see above). Is there a network? Is another apt-get running?"
      say "then run as root:  apt-get update && apt-get install --no-install-recommends $names"
      exit 1
    fi
  fi
  rm -f "$log"
}

apt_install() {
  "${as_root[@]+"${as_root[@]}"}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -q -y -o DPkg::Lock::Timeout=120 install --no-install-recommends "$@"
}

list_packages() {
  local name kind why
  while IFS='|' read -r name kind why; do printf '  %-20s %s\n' "$name" "$why" >&2; done
}

# Systems without apt: the libraries are the user's to install; CMake says which is missing.
ensure_tools() {
  local tool lacking=""
  for tool in cmake ninja; do
    command -v $tool >/dev/null || lacking="$lacking $tool"
  done
  command -v c++ >/dev/null || command -v g++ >/dev/null || command -v clang++ >/dev/null || lacking="$lacking c++"
  case " $* " in *" test "*) command -v python3 >/dev/null || lacking="$lacking python3" ;; esac
  [ -n "$lacking" ] || return 0
  say "this system has no apt-get, so nothing is installed for you. Missing:$lacking"
  say "Percale is built with cmake, ninja and a C++20 compiler, and uses GLFW, Dear ImGui, libepoxy, libpng,"
  say "nlohmann-json, CLI11, oneTBB and, for videos, ffmpeg; docs/building.md has the commands for macOS and Windows."
  exit 1
}

cores() { getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2; }

# build_preset PRESET [TARGET...]: configures if need be and builds. Quiet but for one line of
# progress; on failure prints what the compiler said and returns non-zero.
build_preset() {
  local preset=$1 folder=$root/build/$1 log=$root/build/$1.log line failed=no started=$SECONDS shown=no
  shift
  mkdir -p "$root/build"
  # A copied project must not build into the one it was copied from.
  if [ -f "$folder/CMakeCache.txt" ] &&
    ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
    rm -rf "$folder"
  fi
  if [ ! -f "$folder/build.ninja" ]; then
    say "setting the build up ($preset)"
    if ! (cd "$root" && cmake --preset "$preset") >"$log" 2>&1; then
      cat "$log" >&2
      rm -rf "$folder/CMakeCache.txt"
      say "the build could not be set up; see the messages above"
      return 1
    fi
  fi
  NINJA_STATUS='[%f/%t] ' ninja -C "$folder" -j "$(cores)" "$@" 2>&1 | {
    : >"$log"
    while IFS= read -r line; do
      printf '%s\n' "$line" >>"$log"
      case $line in
        FAILED:* | "ninja: error:"* | "CMake Error"*)
          if [ $failed = no ] && [ $shown = yes ] && [ -t 2 ]; then echo >&2; fi
          failed=yes
          ;;
        "["[0-9]*) [ $failed = yes ] || show_progress "$preset" "$line" ;;
      esac
      [ $failed = no ] || printf '%s\n' "$line" >&2
    done
    if [ $shown = yes ] && [ $failed = no ]; then
      if [ -t 2 ]; then printf '\r\033[K' >&2; fi
      say "built ($preset, $((SECONDS - started)) s)"
    fi
  }
  # Not the loop's status but ninja's.
  if [ "${PIPESTATUS[0]}" -ne 0 ]; then
    say "the build failed ($preset); all of its output is in build/$preset.log"
    return 1
  fi
}

# On a terminal one line that counts, elsewhere one line at the start.
show_progress() {
  local count=${2%%]*}
  if [ -t 2 ]; then
    printf '\r\033[Kpercale: building (%s) %s' "$1" "${count#[}" >&2
  elif [ "$shown" = no ]; then
    say "building ($1), ${count##*/} steps"
  fi
  shown=yes
}

# One build at a time in this folder, where the system can lock files.
lock_build() {
  mkdir -p "$root/build"
  command -v flock >/dev/null || return 0
  exec 9>"$root/build/.lock"
  flock -n 9 || { say "waiting for another build in this folder"; flock 9; }
}
unlock_build() { exec 9>&-; }
