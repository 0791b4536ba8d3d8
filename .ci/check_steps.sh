# shellcheck shell=bash disable=SC2046,SC2086,SC2013,SC2154
# The steps of ./check. Each one adds to passed and failed; summary() tells them in the closing line.

passed=0
failed=0
# what runs under which sanitizer: the address sanitizer takes all but tests that only read files;
# the thread sanitizer takes the rooms where threads meet
asan_leaves_out="architecture first_minutes long"
tsan_takes="base engine osc console query"
# and all of them at once in a window
tsan_takes_of_app=Window.AFloodReloadsAndHandsTogether
# of one thread
tsan_leaves_out_tests='PresetText.*:PanicButton.*:History.EveryBehavior*:History.WithMany*:History.StepsBack*:History.ItGoesAsFar*'
tsan_leaves_out_tests+=:History.ScriptsGoTheSameWay:Take.AWildShow*:SeedWire.EveryAddress*
# long predictions: the release build's runs test them; shorter tests take the same code through the address sanitizer
asan_leaves_out_tests=All/PointGridLanes.EachPairOnce/*:All/PointGridLanes.Finds*/0:JointRows.StopCfm*:Plots.AreTodays:Flock.Without*
asan_leaves_out_tests+=:Scenes.ABehaviorOfAnArm*:Scenes.AGustBends*:Scenes.TheSwarmComes*:Bench.TwoThreads*
asan_leaves_out_tests+=:PanicButton.EveryShow*:History.EveryBehavior*:History.WithMany*:History.StepsBack*
asan_leaves_out_tests+=:PresetText.AHundredMegabytes:Twins.MoveAlike/al*:Twins.MoveAlike/sep*:Twins.MoveAlike/r*:Twins.MoveAlike/vol*

pass() { passed=$((passed + ${1:-1})); }
# fail TEXT LOG: one failed check, with the end of its log
fail() {
  failed=$((failed + 1))
  say "FAILED: $1"
  [ -z "${2-}" ] || tail -n 40 "$2" | sed 's/^/    /'
}

summary() {
  printf '%d passed, %d failed\n' "$passed" "$failed"
  [ "$failed" = 0 ]
  exit
}

# a sanitizer's shadow memory wants addresses that strong address randomisation may take
fixed_addresses() { if setarch -R true 2>/dev/null; then setarch -R "$@"; else "$@"; fi; }

# build FOLDER TARGET...: quiet unless it fails
build() {
  local folder=$1 log begin=$SECONDS
  shift
  log=build/check/build_${folder//\//_}.log
  if cmake --build "$folder" -j "$(jobs)" ${1:+--target "$@"} -- -k 0 >"$log" 2>&1; then
    pass
    say "$folder built in $((SECONDS - begin)) s"
  else
    grep -E 'error|FAILED' "$log" | head -20 >&2
    fail "building $folder (whole output: $log)"
    return 1
  fi
}

# rooms whose tests take longest: they begin first, in two halves, so that no core waits for one of them at the end
slow_rooms="app engine scenes script sim"

# begin_tests FOLDER ROOM...: runs test_ROOM of that build, one a core; each part leaves a log, and its exit code and
# seconds
begin_tests() {
  local folder=$1 room first=() rest=()
  shift
  for room in "$@"; do
    case " $slow_rooms " in *" $room "*) first+=("$room 0 2" "$room 1 2") ;; *) rest+=("$room 0 1") ;; esac
    rm -f "build/check/${folder//\//_}_test_$room".*.end
  done
  export -f fixed_addresses
  printf '%s\n' "${first[@]}" "${rest[@]}" | grep . | test_folder=$folder test_without=${test_without-} \
    test_only=${test_only-} test_emulator=${test_emulator-} test_seconds=${test_seconds:-900} xargs -P "$(jobs)" -L 1 bash -c '
    log=build/check/${test_folder//\//_}_test_$0.$1.log
    begin=$SECONDS
    GTEST_SHARD_INDEX=$1 GTEST_TOTAL_SHARDS=$2 fixed_addresses timeout -k 10 "$test_seconds" \
      $test_emulator "$test_folder/test_$0" --gtest_color=no --gtest_filter="$test_only-$test_without" >"$log" 2>&1
    echo "$? $((SECONDS - begin))" >"${log%.log}.end"'
}

# gather_parts LOG: one log of a program's parts, those that went wrong at its end; sets rc and seconds
gather_parts() {
  local end code took good=() bad=()
  rc=0 seconds=0
  for end in "${1%.log}".*.end; do
    read -r code took <"$end" || return
    if [ "$code" = 0 ]; then good+=("${end%.end}.log"); else bad+=("${end%.end}.log") rc=$code; fi
    seconds=$((took > seconds ? took : seconds))
  done
  cat "${good[@]}" "${bad[@]}" >"$1"
}

# run_tests FOLDER ROOM...: runs those tests and counts them; a skipped one counts as failed
run_tests() {
  local folder=$1 room log ok bad rc seconds built=()
  shift
  for room in "$@"; do
    if [ -x "$folder/test_$room" ]; then built+=("$room"); else fail "$folder/test_$room was not built"; fi
  done
  [ ${#built[@]} != 0 ] || return
  begin_tests "$folder" "${built[@]}"
  for room in "${built[@]}"; do
    log=build/check/${folder//\//_}_test_$room.log
    gather_parts "$log" || { fail "$folder/test_$room did not run"; continue; }
    ok=$(grep -c '\[       OK \]' "$log")
    bad=$(grep -cE '\[  (FAILED  |SKIPPED )\] .* \([0-9]+ ms\)$' "$log")
    pass "$ok"
    failed=$((failed + bad))
    if [ "$bad" != 0 ]; then
      grep -E '\[  (FAILED  |SKIPPED )\] .* \([0-9]+ ms\)$' "$log" | sed 's/^/    /'
      grep -B1 -A8 ': Failure$' "$log" | head -30 | sed 's/^/    /'
    elif [ "$rc" != 0 ]; then
      # it crashed, hung, or a sanitizer spoke after the last test
      fail "$folder/test_$room ended with code $rc (124 and 137: too slow)" "$log"
    elif [ "$ok" = 0 ]; then
      fail "$folder/test_$room holds no test"
    fi
    say "$folder/test_$room: $ok passed, $((bad > 0 ? bad : rc != 0)) failed, $seconds s"
  done
}

# the folders of tests/ that make a test program, without those named in the arguments
test_rooms() {
  local folder room
  for folder in tests/*/; do
    room=$(basename "$folder")
    case " bench fuzz faults $* " in *" $room "*) continue ;; esac
    [ -z "$(find "$folder" -name '*_test.cpp' -print -quit)" ] || printf '%s ' "$room"
  done
}

# while the tests run, the default ports are in use
step_release() {
  local holder
  configure release build -DLIMBER_TESTS=ON -DLIMBER_BENCHMARKS=ON
  build build || return
  exec {holder}> >(exec python3 .ci/hold_ports.py)
  run_tests build $(test_rooms long)
  exec {holder}>&-
}

sanitizer_options() {
  export ASAN_OPTIONS=strict_string_checks=1:detect_stack_use_after_return=0:allocator_may_return_null=1
  export UBSAN_OPTIONS=print_stacktrace=1
  export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan.supp
  ASAN_SYMBOLIZER_PATH=$(command -v "$(newest llvm-symbolizer)")
  export ASAN_SYMBOLIZER_PATH
}

# the newest clang++ that comes with its sanitizers and libFuzzer
clang() {
  local found
  for found in $(compgen -c clang++ | grep -xE 'clang\+\+(-[0-9]+)?' | sort -u -t- -k2 -rV); do
    if echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
      "$found" -fsanitize=address,undefined,fuzzer -x c++ - -o /dev/null 2>/dev/null; then
      printf '%s' "$found"
      return
    fi
  done
  refuse 3 "there is no clang++ with sanitizers and libFuzzer in PATH." "apt-get install clang libclang-rt-dev"
}

configure_asan() {
  local compiler
  compiler=$(clang) || exit
  configure asan build/asan "-DCMAKE_CXX_COMPILER=$compiler"
}

# at most 40 s of what `--long valgrind` does in full
step_valgrind() {
  build_program || return
  memcheck_scenes 12 < <(memory_scenes)
}

step_asan() {
  sanitizer_options
  configure_asan
  local rooms=($(test_rooms $asan_leaves_out))
  build build/asan "${rooms[@]/#/test_}" && test_without=$asan_leaves_out_tests run_tests build/asan "${rooms[@]}"
}

step_tsan() {
  sanitizer_options
  configure tsan build/tsan
  local rooms=() room
  for room in $tsan_takes; do
    case " $(test_rooms)" in *" $room "*) rooms+=("$room") ;; esac
  done
  build build/tsan "${rooms[@]/#/test_}" test_app || return
  test_without=$tsan_leaves_out_tests run_tests build/tsan "${rooms[@]}"
  test_only=$tsan_takes_of_app run_tests build/tsan app
}

# run_fuzz NAME ARGUMENTS...: replays the corpus, then looks for more; what it finds stays in build/check/fuzz. Leaves a
# log and its exit code. Leaks are looked for once, at the end: a world that lives on grows, and libFuzzer would search
# it after every input
run_fuzz() {
  local name=$1 short=${1%_fuzz} log=build/check/$1.log found=build/check/fuzz/$1 seeds=() dictionary=()
  shift
  mkdir -p "$found"
  [ ! -d "tests/fuzz/corpus/$short" ] || seeds=("tests/fuzz/corpus/$short")
  [ ! -e "tests/fuzz/$short.dict" ] || dictionary=("-dict=tests/fuzz/$short.dict")
  fixed_addresses "build/asan/$name" -timeout=20 -rss_limit_mb=4096 -detect_leaks=0 \
    -artifact_prefix="$found/bad-" -print_final_stats=1 "${dictionary[@]}" "$@" "${seeds[@]}" >"$log" 2>&1
  echo $? >"${log%.log}.end"
}

count_fuzz() {
  local log=build/check/$1.log rc=none
  read -r rc <"${log%.log}.end"
  if [ "$rc" = 0 ]; then
    pass
    say "$1: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs without a fault"
  else
    fail "$1 (the input is in build/check/fuzz/$1)" "$log"
  fi
}

fuzz_names() { (cd tests/fuzz 2>/dev/null && ls ./*_fuzz.cpp 2>/dev/null) | sed 's|^\./||; s|\.cpp$||'; }

# how many inputs a target takes in at most about fifteen seconds
fuzz_runs() { case $1 in osc*) echo 90000 ;; script*) echo 1100 ;; websocket*) echo 2600 ;; *) echo 15000 ;; esac; }

# as alike as it can be: one seed, a number of runs, nothing from the runs before; the time is a cap for a slow machine
# alone. (In a live world Lua's collector stops by the clock, so the OSC target's runs differ a little.)
step_fuzz() {
  local names name
  sanitizer_options
  names=$(fuzz_names)
  [ -n "$names" ] || { say "no fuzz targets"; return; }
  [ -e build/asan/build.ninja ] || configure_asan
  build build/asan $names || return
  # libFuzzer writes to the first folder that it is given
  rm -rf build/check/fuzz_new
  (cd build/check && rm -f ./*_fuzz.end)
  export -f fixed_addresses run_fuzz fuzz_runs
  printf '%s\n' $names | xargs -P "$(jobs)" -I NAME bash -c '
    mkdir -p build/check/fuzz_new/NAME
    run_fuzz NAME -seed=1 -runs="$(fuzz_runs NAME)" -max_total_time=300 build/check/fuzz_new/NAME'
  for name in $names; do count_fuzz "$name"; done
}

# each script names what it needs in a line "# needs: PROGRAM..."
scripts() {
  local script program left_out=()
  for script in "$1"/*.sh; do
    [ -e "$script" ] || break
    for program in $(sed -n 's/^# needs: //p' "$script"); do
      command -v "$program" >/dev/null || { left_out+=("$(basename "$script") (needs $program)"); continue 2; }
    done
    if bash "$script" >"build/check/$(basename "$script").log" 2>&1; then pass; else
      fail "$script" "build/check/$(basename "$script").log"; fi
  done
  say "left out: ${left_out[*]:-nothing}"
}

# our C++ files, in the index or new
cpp_files() { git ls-files -co --exclude-standard -- 'src/*.cpp' 'src/*.h' 'tests/*.cpp' 'tests/*.h'; }

# what differs from the main branch, or, on the main branch, from the commit before
changed_files() {
  local base
  base=$(git merge-base HEAD origin/main 2>/dev/null)
  if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then base=$(git rev-parse -q --verify HEAD~1 || git rev-parse HEAD); fi
  { git diff --name-only --diff-filter=d "$base"; git ls-files -o --exclude-standard; } | grep -E '^(src|tests)/.*\.cpp$' | sort -u
}

# files, a line each -> some files of one folder in a line; built-in behaviours have names in common, as in a unity build
lint_groups() {
  awk '{ folder = $0; sub("/[^/]*$", "", folder)
         if (folder != last || count == 6 || folder == "src/behaviors") { if (NR > 1) print ""; count = 0 }
         printf "%s%s", (count++ ? " " : ""), $0; last = folder } END { print "" }'
}

step_style() {
  local log=build/check/format.log files
  git rev-parse --git-dir >/dev/null 2>&1 || { say "no git checkout: format and lint left out"; return; }
  # another version formats differently and warns of other things
  if ! command -v clang-format-14 >/dev/null || ! command -v clang-tidy-14 >/dev/null; then
    say "no clang-format-14 and clang-tidy-14 (Debian 12 has them): format and lint left out"
    return
  fi
  if cpp_files | xargs -r clang-format-14 --dry-run -Werror >"$log" 2>&1; then pass; else
    fail "format; cure: clang-format-14 -i on $(sed -n 's/^\([^:]*\):.*error:.*/\1/p' "$log" | sort -u | tr '\n' ' ')"
  fi
  case ${LIMBER_TIDY:-changed} in all) files=$(cpp_files | grep '\.cpp$') ;; off) files= ;; *) files=$(changed_files) ;; esac
  [ -n "$files" ] || return
  log=build/check/tidy.log
  if lint_groups <<<"$files" | xargs -P "$(jobs)" -L 1 .ci/tidy >"$log" 2>&1; then
    pass
    say "clang-tidy: $(wc -l <<<"$files") files clean"
  else
    grep -E 'warning:|error:' "$log" | sort -u | head -40 | sed 's/^/    /'
    fail "clang-tidy (whole output: $log)"
  fi
}
