# shellcheck shell=bash disable=SC2046,SC2086,SC2154
# ./check --faults: plants the mutations of tests/mutations in a copy of the last commit; tests must fail for each.
# All mutations of C++ functions are in one build, and the environment variable LIMBER_MUTATION chooses one.

copy=build/faults/tree
table=build/check/faults.txt
list=build/check/mutations.tsv

# fault_build KIND TARGET...: KIND is plain, asan or tsan
fault_build() {
  local kind=$1 folder=$PWD/$copy/build/$1 options=()
  shift
  case $kind in
    asan) options=(-DLIMBER_SANITIZE=address "-DCMAKE_CXX_COMPILER=$(clang)") ;;
    tsan) options=(-DLIMBER_SANITIZE=thread) ;;
  esac
  if [ ! -e "$folder/build.ninja" ]; then
    cmake -S "$copy" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Sanitize -DLIMBER_TESTS=ON -DLIMBER_UNITY=ON "${options[@]}" || return
  fi
  cmake --build "$folder" -j "$(jobs)" --target "$@"
}

# kind_and_program WORD: prints "plain:test_sim" for "test_sim"; a word with a kind, such as "tsan:test_base", is unchanged
kind_and_program() { case $1 in *:*) echo "$1" ;; *) echo "plain:$1" ;; esac; }

# Prints all "kind:program" of the list, each once.
programs() { local word; for word in $(cut -f3 "$list" | tr ';' '\n' | cut -d'|' -f1 | sort -u); do kind_and_program "$word"; done; }

# Builds the programs of the list.
build_all() {
  local kind rc=0
  for kind in $(programs | cut -d: -f1 | sort -u); do
    case $kind in
      valgrind) fault_build plain limber || rc=1 ;;
      *) fault_build "$kind" $(programs | sed -n "s/^$kind://p") || rc=1 ;;
    esac
  done
  return $rc
}

# passes KIND:PROGRAM FILTER: runs a test program until its first failure; "valgrind:joints" plays that scene of tests/memory
# under valgrind
passes() {
  local name=${1#*:}
  case $1 in valgrind:*)
    program=$copy/build/plain/limber memcheck_scene 12 $(memory_scenes | grep "^$name ")
    cat "build/check/valgrind_$name.log"
    [ "$(<"build/check/valgrind_$name.end")" = 0 ]
    return ;;
  esac
  fixed_addresses timeout -k 5 "${LIMBER_FAULT_SECONDS:-300}" "$copy/build/${1%%:*}/${1#*:}" \
    --gtest_color=no --gtest_fail_fast --gtest_filter="${2:-*}"
}

verdict_line() { printf '%-40s %-9s %s\n' "$@" | tee -a "$table"; }

# first_failure LOG: prints the first failed test
first_failure() {
  grep -m1 -oE 'FAILED  \] [A-Za-z0-9_./]+|SUMMARY: .*|uninitialised value' "$1" | sed 's/FAILED  \] //' || echo "ended or timed out"
}

# try_mutation NAME TESTS FAULT: runs the tests with a mutation; it survives if all pass
try_mutation() {
  local name=$1 fault=$3 log=build/check/fault_$1.log test word filter
  : >"$log"
  while IFS='|' read -r word filter; do
    if ! LIMBER_MUTATION=$name passes "$(kind_and_program "$word")" "$filter" >>"$log" 2>&1; then
      verdict_line "$name" noticed "$word: $(first_failure "$log")"
      return
    fi
  done < <(tr ';' '\n' <<<"$2")
  verdict_line "$name" SURVIVED "no test noticed: $fault"
}

# try_alone NAME TESTS FAULT NAMES...: builds and tries a mutation of a file that is not C++
try_alone() {
  local name=$1 tests=$2 fault=$3
  shift 3
  python3 tests/mutations/plant.py --folder "$copy" --alone "$name" -- "$@"
  if build_all >"build/check/fault_$name.log" 2>&1; then
    try_mutation "$name" "$tests" "$fault"
  else
    verdict_line "$name" BROKEN "it does not build: build/check/fault_$name.log"
  fi
}

# faults NAME...: tries all mutations, or those with a name that starts with one of these.
faults() {
  local word log=build/check/fault_baseline.log name how tests fault begin=$SECONDS
  sanitizer_options
  : >"$table"
  [ -z "$(git status --porcelain --untracked-files=no -- src tests CMakeLists.txt)" ] ||
    say "uncommitted changes to sources are not part of the copy: mutations are planted in the last commit"
  mkdir -p "$copy"
  # tests look for extra data beside the checkout, so it is beside the copy as well
  [ ! -e ../shared ] || ln -sfn "$(realpath ../shared)" build/faults/shared
  python3 tests/mutations/plant.py --folder "$copy" --table "$list" -- "$@" || die 2 "the mutations can't be planted." \
    "see above; 'python3 tests/mutations/plant.py' checks all entries."
  say "building $(programs | tr '\n' ' ')with $(wc -l <"$list") mutations"
  build_all >"$log" 2>&1 || { fail "the build with all mutations" "$log"; return; }
  say "built in $((SECONDS - begin)) s"
  # all tests must pass without a mutation; otherwise a failure would prove nothing
  for word in $(programs); do
    passes "$word" >>"$log" 2>&1 || { fail "$word fails without a mutation" "$log"; return; }
  done
  say "tests without a mutation pass, $((SECONDS - begin)) s"
  verdict_line mutation verdict by
  while IFS=$'\t' read -r name how tests fault; do
    if [ "$how" = alone ]; then try_alone "$name" "$tests" "$fault" "$@" </dev/null; else try_mutation "$name" "$tests" "$fault" </dev/null; fi
  done <"$list"
  say "the whole run took $((SECONDS - begin)) s; the table is in $table"
  pass "$(grep -c ' noticed ' "$table")"
  failed=$((failed + $(grep -cE ' (SURVIVED|BROKEN) ' "$table")))
}
