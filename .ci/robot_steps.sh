# shellcheck shell=bash disable=SC2046,SC2086,SC2154
# Tests of URDF files from other projects: each robot stands, and follows random targets, with a free and a fixed base.

# play_robot FILE true|false: prints the result of tests/robots/stand_and_follow.lua, and whether it was unstable.
play_robot() {
  local scene
  scene=build/check/robots/$(basename "$1" .urdf)_$2.lua
  {
    printf 'local robot_file, free_base = "%s", %s\n' "$(realpath "$1")" "$2"
    cat tests/robots/stand_and_follow.lua
  } >"$scene"
  timeout -k 10 600 build/limber play "$scene" --fast --duration 20.1 --osc-in off --osc-out off --query off \
    </dev/null 2>&1 | awk '/^robot /{result = $0} /last good pose/{more = ", unstable"} END{print result more}'
}

robot_verdict() {
  local result
  result=$(play_robot "$1" "$2")
  printf '%s %s: %s\n' "$1" "$([ "$2" = true ] && echo free || echo fixed)" "${result:-it did not play}"
}

# --long robots: the URDF files in LIMBER_ROBOTS (default: ../shared/data/urdf_synthetic) and urdf/ stand and follow
long_robots() {
  local folder=${LIMBER_ROBOTS:-../shared/data/urdf_synthetic} line
  build_program || return
  if [ ! -d "$folder" ]; then
    [ -z "$LIMBER_ROBOTS" ] || { fail "LIMBER_ROBOTS: $folder is not a folder"; return; }
    say "there is no $folder: only the robots in urdf/ play"
    folder=
  fi
  mkdir -p build/check/robots
  export -f play_robot robot_verdict
  while read -r line; do
    if [ "${line##*: }" = "robot fine" ]; then pass; else fail "$line"; fi
  done < <(find urdf ${folder:+"$folder"} -name '*.urdf' -size +0 | sort | sed 'h; s/$/ true/p; g; s/$/ false/' |
    xargs -P "$(jobs)" -L 1 bash -c 'robot_verdict "$@"' robots)
}
