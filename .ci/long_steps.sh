# shellcheck shell=bash disable=SC2046,SC2086,SC2154
# The parts of ./check --long. A part is a function long_NAME in a file *_steps.sh, with a comment "# --long NAME: …" for
# the help, or a fuzz target. It takes an hour at most. Parts that passed with the same files are skipped, so that an
# interrupted run can be continued.

part_names() { compgen -A function long_ | sed 's/^long_//'; fuzz_names; }

# Prints the lines of the help.
describe_parts() {
  sed -n 's/^# --long \([a-z0-9_]*\): \(.*\)/\1|\2/p' .ci/*_steps.sh | while IFS='|' read -r name text; do
    printf '  %-16s %s\n' "$name" "$text"
  done
  printf '  %-16s %s\n' "NAME_fuzz" "30 minutes of a fuzz target: $(fuzz_names | tr '\n' ' ')"
}

# Prints the commit; fails if files differ from it, because results would not belong to a commit.
clean_commit() { [ -z "$(git status --porcelain 2>&1)" ] && git rev-parse --short=10 HEAD; }

# run_part NAME: runs a part; if it passes, writes a stamp file with the commit and the folder of robots.
run_part() {
  local stamp=build/check/long/$1.passed commit before=$failed begin=$SECONDS
  commit=$(clean_commit) && commit+=${LIMBER_ROBOTS:+ $LIMBER_ROBOTS} || commit=none
  mkdir -p build/check/long
  if [ "$commit" != none ] && [ "$(cat "$stamp" 2>/dev/null)" = "$commit" ]; then
    pass
    say "$1: passed already at $commit (to run it again, remove $stamp)"
    return
  fi
  rm -f "$stamp"
  case $1 in *_fuzz) fuzz_at_length "$1" ;; *) "long_$1" ;; esac
  if [ "$failed" = "$before" ]; then
    [ "$commit" = none ] || printf '%s\n' "$commit" >"$stamp"
    say "$1: passed in $((SECONDS - begin)) s"
  else
    say "$1: FAILED in $((SECONDS - begin)) s"
  fi
}

# step_long NAME...: runs these parts, or all without a name.
step_long() {
  local name
  sanitizer_options
  say "--long: replace the figures in docs/understand/measurements.md"
  [ $# != 0 ] || set -- $(part_names)
  for name; do run_part "$name"; done
}

# New inputs stay in build/check/fuzz/NAME, where the next run continues.
fuzz_at_length() {
  [ -e build/asan/build.ninja ] || configure_asan
  build build/asan "$1" || return
  case $1 in
    osc*) run_fuzz "$1" -runs=10000000 -max_total_time=3600 "build/check/fuzz/$1" ;;
    *) run_fuzz "$1" -max_total_time=$((${LIMBER_LONG_MINUTES:-30} * 60)) "build/check/fuzz/$1" ;;
  esac
  count_fuzz "$1"
}

# tests_at_length FILTER: runs these tests of tests/long.
tests_at_length() {
  configure release build -DLIMBER_TESTS=ON -DLIMBER_BENCHMARKS=ON
  build build test_long && test_seconds=3600 test_only=$1 run_tests build long
}

# --long processes: equal results of twenty processes: paced, fast, pinned, with and without streams and ASLR
long_processes() { tests_at_length 'LongDeterminism.*'; }
# --long flood: three senders at maximum rate
long_flood() { tests_at_length 'Flood.*'; }
# --long soak: memory use in an hour of simulated time, and a flood of queries
long_soak() { tests_at_length 'Soak.*'; }
# --long crash: recovery of 200 killed sessions
long_crash() { tests_at_length 'LongCrash.*'; }
# --long evolve: a search with 150 killed child processes and 50 killed jobs
long_evolve() { tests_at_length 'LongEvolve.*'; }
# --long mocap: a million broken frames of motion capture against the limits of lights and motors
long_mocap() { tests_at_length 'LongMocap.*'; }
# --long takes: takes of ten minutes with random input, and of many random seeds
long_takes() { tests_at_length 'LongTake.*'; }
# --long lua_difference: a million random Lua programs, compiled against interpreted (LIMBER_LUA_PROGRAMS)
# The progress is stored with the commit, so that an interrupted run can be continued.
long_lua_difference() {
  local note=build/check/long/lua_difference.seed commit first=1 seed programs=${LIMBER_LUA_PROGRAMS:-1000000}
  commit=$(clean_commit) || commit=none
  [ "$commit" != none ] && [ "$(cat "$note.commit" 2>/dev/null)" = "$commit" ] && first=$(cat "$note" 2>/dev/null || echo 1)
  printf '%s\n' "$commit" >"$note.commit"
  seed=${first:-1}
  [ "$seed" -gt "$programs" ] && seed=1
  say "lua_difference: programs $seed to $programs"
  configure release build -DLIMBER_TESTS=ON -DLIMBER_BENCHMARKS=ON
  export LIMBER_LUA_SEED=$seed LIMBER_LUA_PROGRAMS=$((programs - seed + 1)) LIMBER_LUA_PROGRESS=$note
  build build test_script && test_seconds=3600 test_only='LuaDifference.*' run_tests build script
  unset LIMBER_LUA_SEED LIMBER_LUA_PROGRAMS LIMBER_LUA_PROGRESS
  rm -f "$note.commit"
}
# --long asan: the tests of all modules with the address and undefined-behavior sanitizers
long_asan() { with_asan $(test_modules $asan_leaves_out); }
# --long asan_app: the same for the program's commands
long_asan_app() {
  configure_asan
  build build/asan limber && with_asan app
}
# --long tsan: the tests of all modules that use several threads, with the thread sanitizer
long_tsan() { with_tsan $tsan_takes_long; }
# --long bench: the tests of the measurements and benchmark programs; step rates from Lua, C++ and Python, and MuJoCo's
long_bench() {
  configure release build -DLIMBER_TESTS=ON -DLIMBER_BENCHMARKS=ON
  build build test_bench limber_measure limber_bench && run_tests build bench
  compare_step_rates
}
# Also makes a million steps from Python.
compare_step_rates() {
  local log=build/check/step_rates.log targets="limber limber_python limber_steps_library"
  grep -q limber_steps_mujoco build/build.ninja && targets+=" limber_steps_mujoco"
  build build $targets || return
  if tests/bench/step_rates build --memory 1000000 >"$log" 2>&1; then pass; else fail "the step rates" "$log"; fi
  say "$(cat "$log")"
}
# --long math: the math functions against MPFR, ten million arguments each, and all floats
long_math() { tests_at_length 'LongMath*'; }
# --long environment: a session with full disks, hung displays, floods and so on; writes docs/reference/environments.md
long_environment() {
  configure release build
  build build limber || return
  if tests/environment/run build/limber --page docs/reference/environments.md >build/check/environment.log 2>&1; then
    pass
  else
    fail "environment: $(grep -c '^FAIL' build/check/environment.log) rows differ: build/check/environment.log"
  fi
  say "$(tail -n 1 build/check/environment.log)"
}
# --long show_soak: 45 minutes with everything at once: saves, floods, rewinds, takes, killed clients, a full disk
long_show_soak() {
  configure release build
  build build limber || return
  if tests/environment/soak build/limber 45 >build/check/show_soak.log 2>&1; then pass; else
    fail "the soak: $(tail -n 1 build/check/show_soak.log)"
  fi
  say "$(tail -n 1 build/check/show_soak.log)"
}
