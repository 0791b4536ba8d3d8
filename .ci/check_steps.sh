# shellcheck shell=bash disable=SC2046,SC2086,SC2013,SC2154
# The steps of ./check. Each one adds to passed and failed; summary() prints both in the last line.

passed=0
failed=0
# Lists of modules, that is folders of tests/; check_module_lists finds names that do not exist. The sanitizers run those
# that read data of others or use several threads, because three builds of all tests take too long; --long asan and
# --long tsan run the others, too. Tests that are too slow there leave themselves out (tests/support/skip.h).
asan_takes="model script engine osc oscquery midi"
tsan_takes="osc midi stress"
tsan_takes_long="base engine osc lighting link midi console oscquery stress"
# Not in the address sanitizer at all, because they only read files or measure; app: --long asan_app.
asan_leaves_out="app architecture bench first_minutes long"
# Not in ./check: --long bench, and the parts of tests/long.
long_modules="bench long"
# The modules with the longest tests. They start first, in two halves, to keep all cores busy until the end.
slow_modules="app engine scenes script sim"
# Modules that .ci/arm64 runs with qemu. The others do not depend on the architecture, take too long (engine, panel: minutes
# per test), or need a display or other programs (render, app).
emulated_modules="osc base properties model script export console"

pass() { passed=$((passed + ${1:-1})); }
# fail TEXT LOG: counts a failed check and prints the end of its log.
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

# Runs a command without address space randomization, which may conflict with a sanitizer's shadow memory.
fixed_addresses() { if setarch -R true 2>/dev/null; then setarch -R "$@"; else "$@"; fi; }

# build FOLDER TARGET...: builds; prints errors only.
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

# begin_tests FOLDER MODULE...: runs test_MODULE of that build, one per core. Each part writes a log, and its exit code and
# duration in seconds.
begin_tests() {
  local folder=$1 module first=() rest=()
  shift
  for module in "$@"; do
    case " $slow_modules " in *" $module "*) first+=("$module 0 2" "$module 1 2") ;; *) rest+=("$module 0 1") ;; esac
    rm -f "build/check/${folder//\//_}_test_$module".*.end
  done
  export -f fixed_addresses
  printf '%s\n' "${first[@]}" "${rest[@]}" | grep . | test_folder=$folder \
    test_only=${test_only-} test_emulator=${test_emulator-} test_seconds=${test_seconds:-900} xargs -P "$(jobs)" -L 1 bash -c '
    log=build/check/${test_folder//\//_}_test_$0.$1.log
    begin=$SECONDS
    GTEST_SHARD_INDEX=$1 GTEST_TOTAL_SHARDS=$2 fixed_addresses timeout -k 10 "$test_seconds" \
      $test_emulator "$test_folder/test_$0" --gtest_color=no --gtest_filter="${test_only:-*}" >"$log" 2>&1
    echo "$? $((SECONDS - begin))" >"${log%.log}.end"'
}

# gather_parts LOG: concatenates the logs of a program's parts, failed ones last; sets rc and seconds.
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

# check_filter PROGRAM: fails for each pattern in test_only that selects no test of the program.
check_filter() {
  local pattern
  while read -r pattern; do
    [ -z "$pattern" ] || ${test_emulator-} "$1" --gtest_list_tests --gtest_filter="$pattern" 2>/dev/null | grep -q . ||
      fail "$1 has no tests '$pattern'"
  done < <(tr ':' '\n' <<<"${test_only-}")
}

# run_tests FOLDER MODULE...: runs and counts tests. Those that leave themselves out in this build are not counted; any
# other skipped test counts as failed.
run_tests() {
  local folder=$1 module log ok bad out rc seconds built=()
  shift
  for module in "$@"; do
    if [ -x "$folder/test_$module" ]; then
      built+=("$module")
      check_filter "$folder/test_$module"
    else
      fail "$folder/test_$module was not built"
    fi
  done
  [ ${#built[@]} != 0 ] || return
  begin_tests "$folder" "${built[@]}"
  for module in "${built[@]}"; do
    log=build/check/${folder//\//_}_test_$module.log
    gather_parts "$log" || { fail "$folder/test_$module did not run"; continue; }
    ok=$(grep -c '\[       OK \]' "$log")
    out=$(grep -c '^left out: ' "$log")
    bad=$(($(grep -cE '\[  (FAILED  |SKIPPED )\] .* \([0-9]+ ms\)$' "$log") - out))
    pass "$ok"
    failed=$((failed + bad))
    if [ "$bad" != 0 ]; then
      grep -E '\[  (FAILED  |SKIPPED )\] .* \([0-9]+ ms\)$' "$log" | sed 's/^/    /'
      grep -B1 -A8 ': Failure$' "$log" | head -30 | sed 's/^/    /'
    elif [ "$rc" != 0 ]; then
      # it crashed, hung, or a sanitizer reported an error after the last test
      fail "$folder/test_$module ended with code $rc (124 and 137: too slow)" "$log"
    elif [ "$ok" = 0 ]; then
      fail "$folder/test_$module has no test"
    fi
    say "$folder/test_$module: $ok passed, $((bad > 0 ? bad : rc != 0)) failed, $out left out, $seconds s"
  done
}

# Prints the folders of tests/ that have a test program, without those in the arguments.
test_modules() {
  local folder module
  for folder in tests/*/; do
    module=$(basename "$folder")
    case " fuzz $* " in *" $module "*) continue ;; esac
    [ -z "$(find "$folder" -name '*_test.cpp' -print -quit)" ] || printf '%s ' "$module"
  done
}

# Fails for each name in the lists of modules that is no module, such as the old name of a renamed one.
check_module_lists() {
  local list name known
  known=" $(test_modules)"
  for list in asan_takes tsan_takes tsan_takes_long asan_leaves_out long_modules slow_modules emulated_modules; do
    for name in ${!list}; do
      case $known in *" $name "*) pass ;; *) fail "$list names the module $name, but tests/$name has no tests" ;; esac
    done
  done
}

# Occupies the default ports while the tests run.
step_release() {
  local holder
  configure release build -DLIMBER_TESTS=ON -DLIMBER_BENCHMARKS=ON
  build build || return
  exec {holder}> >(exec python3 .ci/hold_ports.py)
  run_tests build $(test_modules $long_modules)
  exec {holder}>&-
}

sanitizer_options() {
  export ASAN_OPTIONS=strict_string_checks=1:detect_stack_use_after_return=0:allocator_may_return_null=1
  export UBSAN_OPTIONS=print_stacktrace=1
  export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1:suppressions=$PWD/tests/tsan.supp
  ASAN_SYMBOLIZER_PATH=$(command -v "$(newest llvm-symbolizer)")
  export ASAN_SYMBOLIZER_PATH
}

# Prints the newest clang++ with sanitizers and libFuzzer.
clang() {
  local found
  for found in $(compgen -c clang++ | grep -xE 'clang\+\+(-[0-9]+)?' | sort -u -t- -k2 -rV); do
    if echo 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
      "$found" -fsanitize=address,undefined,fuzzer -x c++ - -o /dev/null 2>/dev/null; then
      printf '%s' "$found"
      return
    fi
  done
  die 3 "there is no clang++ with sanitizers and libFuzzer in PATH." "apt-get install clang libclang-rt-dev"
}

configure_asan() {
  local compiler
  compiler=$(clang) || exit
  configure asan build/asan "-DCMAKE_CXX_COMPILER=$compiler"
}

# A short form of `--long valgrind`: 40 s at most.
step_valgrind() {
  build_program || return
  memcheck_scenes 12 < <(memory_scenes)
}

# with_asan MODULE..., with_tsan MODULE...: builds and runs the tests of modules with a sanitizer.
with_asan() {
  sanitizer_options
  configure_asan
  build build/asan "${@/#/test_}" && run_tests build/asan "$@"
}
with_tsan() {
  sanitizer_options
  configure tsan build/tsan
  build build/tsan "${@/#/test_}" && run_tests build/tsan "$@"
}

step_asan() { with_asan $asan_takes; }
step_tsan() { with_tsan $tsan_takes; }

# run_fuzz NAME ARGUMENTS...: replays the corpus, then generates inputs; interesting ones stay in build/check/fuzz. Writes a
# log and the exit code. Leak detection runs once at the end, because libFuzzer would run it after every input that makes
# the world grow.
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
    say "$1: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs without an error"
  else
    fail "$1 (the input is in build/check/fuzz/$1)" "$log"
  fi
}

fuzz_names() { (cd tests/fuzz 2>/dev/null && ls ./*_fuzz.cpp 2>/dev/null) | sed 's|^\./||; s|\.cpp$||'; }

# Prints the number of inputs that a target processes in about 7 seconds.
fuzz_runs() { case $1 in osc*) echo 40000 ;; script*) echo 500 ;; websocket*) echo 1200 ;; *) echo 7000 ;; esac; }

# Repeatable as far as possible: one seed, a fixed number of runs, no inputs of earlier runs; the time limit is for slow
# machines only. (Lua's garbage collector has a time limit, so runs of the OSC target differ slightly.)
step_fuzz() {
  local names name
  sanitizer_options
  names=$(fuzz_names)
  [ -n "$names" ] || { say "no fuzz targets"; return; }
  [ -e build/asan/build.ninja ] || configure_asan
  build build/asan $names || return
  # libFuzzer writes to the first folder in its arguments
  rm -rf build/check/fuzz_new
  (cd build/check && rm -f ./*_fuzz.end)
  export -f fixed_addresses run_fuzz fuzz_runs
  printf '%s\n' $names | xargs -P "$(jobs)" -I NAME bash -c '
    mkdir -p build/check/fuzz_new/NAME
    run_fuzz NAME -seed=1 -runs="$(fuzz_runs NAME)" -max_total_time=300 build/check/fuzz_new/NAME'
  for name in $names; do count_fuzz "$name"; done
}

# Runs the scripts of a folder. A script declares required programs in a line "# needs: PROGRAM...".
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
  say "skipped: ${left_out[*]:-nothing}"
}

# Prints the C++ files of the project, tracked or new.
cpp_files() { git ls-files -co --exclude-standard -- 'src/*.cpp' 'src/*.h' 'tests/*.cpp' 'tests/*.h'; }

# Prints the files that differ from the main branch, or on the main branch from the previous commit.
changed_files() {
  local base
  base=$(git merge-base HEAD origin/main 2>/dev/null)
  if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then base=$(git rev-parse -q --verify HEAD~1 || git rev-parse HEAD); fi
  { git diff --name-only --diff-filter=d "$base"; git ls-files -o --exclude-standard; } | grep -E '^(src|tests)/.*\.cpp$' | sort -u
}

# Groups files, one per line, into lines of up to six files of one folder. Built-in behaviors are not grouped, because
# their names collide, as in a unity build.
lint_groups() {
  awk '{ folder = $0; sub("/[^/]*$", "", folder)
         if (folder != last || count == 6 || folder == "src/sim/behavior/builtin") { if (NR > 1) print ""; count = 0 }
         printf "%s%s", (count++ ? " " : ""), $0; last = folder } END { print "" }'
}

# The pages of the documentation, and the site that mkdocs builds from them.
check_docs() {
  local log=build/check/docs.log
  if { python3 .ci/docs_test.py && .ci/docs.py && .ci/questions.py; } >"$log" 2>&1; then pass; else fail "pages of the documentation" "$log"; fi
  command -v mkdocs >/dev/null || { say "no mkdocs: the documentation's site skipped"; return; }
  log=build/check/site.log
  if mkdocs build --strict --clean -d "$PWD/build/check/site" >"$log" 2>&1 &&
    python3 .ci/package/site_links.py build/check/site docs >>"$log" 2>&1; then pass; else
    fail "the documentation's site" "$log"
  fi
}

step_style() {
  local log=build/check/format.log files
  check_module_lists
  if .ci/words.py >build/check/words.log 2>&1; then pass; else fail "wording" build/check/words.log; fi
  if .ci/measures.py --check >build/check/measures.log 2>&1; then pass; else fail "measures" build/check/measures.log; fi
  if python3 tests/mutations/plant.py >build/check/plant.log 2>&1; then pass; else fail "mutations" build/check/plant.log; fi
  check_docs
  git rev-parse --git-dir >/dev/null 2>&1 || { say "no git checkout: format and lint skipped"; return; }
  # other versions format differently and have other warnings
  if ! command -v clang-format-14 >/dev/null || ! command -v clang-tidy-14 >/dev/null; then
    say "no clang-format-14 and clang-tidy-14 (Debian 12 has them): format and lint skipped"
    return
  fi
  if cpp_files | xargs -r clang-format-14 --dry-run -Werror >"$log" 2>&1; then pass; else
    fail "format; fix: clang-format-14 -i on $(sed -n 's/^\([^:]*\):.*error:.*/\1/p' "$log" | sort -u | tr '\n' ' ')"
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
