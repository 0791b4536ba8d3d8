# shellcheck shell=bash disable=SC2154
# Tests on other Debian releases, in roots made by .ci/chroot; need root, and network access for packages. The parts of a
# release share a root with its packages and builds; trixie_run and sid start with a minimal root.

# in_debian RELEASE NAME OPTION... -- COMMAND...: runs COMMAND in that release and writes a log.
in_debian() {
  local release=$1 log=build/check/debian_$1_$2.log
  shift 2
  .ci/chroot "$release" "$@" </dev/null >"$log" 2>&1
}

# passes_in_debian RELEASE NAME OPTION... -- COMMAND...: counts one check, which passes if COMMAND exits with 0.
passes_in_debian() {
  if in_debian "$@"; then pass; else fail "$2 on Debian $1" "build/check/debian_$1_$2.log"; fi
}

# check_in_debian RELEASE NAME STEPS: runs ./check --only STEPS in that release and adds its counts.
check_in_debian() {
  local log=build/check/debian_$1_$2.log counts
  in_debian "$1" "$2" -- ./check --only "$3"
  if read -r -a counts < <(grep -xE '[0-9]+ passed, [0-9]+ failed' "$log" | tr -d ,); then
    pass "${counts[0]}"
    failed=$((failed + counts[2]))
    grep -E 'FAILED|SKIPPED' "$log" | sort -u | sed 's/^/    /'
  else
    fail "./check --only $3 on Debian $1" "$log"
  fi
}

played='build/limber play --headless --fast --ticks 120 --hash --osc-in off --osc-out off --query off'

# --long trixie_run: ./run on a minimal Debian 13
long_trixie_run() {
  passes_in_debian trixie run --fresh -- ./run --build-only
  passes_in_debian trixie play -- sh -c "$played"
}
# --long trixie_release: the release build's tests, and valgrind, on Debian 13
long_trixie_release() { check_in_debian trixie release style,release,valgrind; }
# --long trixie_asan: the address sanitizer's tests, and the fuzz targets, on Debian 13
long_trixie_asan() { check_in_debian trixie asan asan,fuzz; }
# --long trixie_tsan: the thread sanitizer's tests on Debian 13
long_trixie_tsan() { check_in_debian trixie tsan tsan; }
# --long sid: ./run on a minimal Debian sid, with newer compilers and libraries
long_sid() {
  passes_in_debian sid run --fresh -- ./run --build-only
  passes_in_debian sid play -- sh -c "$played"
}
