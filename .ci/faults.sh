# shellcheck shell=bash disable=SC2046,SC2086,SC2154
# ./check --faults: each small fault in tests/faults is applied to a copy of the tree; the tests must turn red.
# The copy is the last commit; the patches are those of the working tree, so that a new one can be tried.

copy=build/faults/tree
table=build/check/faults.txt

# fault_line FILE WORD: what the patch's head says after "# WORD:"
fault_line() { sed -n '/^diff /q; /^--- /q; s/^# '"$2"': *//p' "$1"; }

# the copy stands at the last commit again, and only files that differ get a new time, so builds stay incremental
renew_copy() {
  local head
  head=$(git rev-parse HEAD)
  [ -z "$(git status --porcelain --untracked-files=no -- src tests CMakeLists.txt)" ] ||
    say "uncommitted changes are not part of the copy: the faults meet the last commit"
  if [ ! -e "$copy/.git" ]; then
    rm -rf build/faults && git worktree prune && mkdir -p build/faults
    git worktree add -q --detach "$copy" "$head" || refuse 3 "git cannot make a second working tree in $copy." \
      "work in a clone made by git clone, with free space on the disk."
  fi
  git -C "$copy" reset -q --hard "$head" && git -C "$copy" clean -qfd
  # tests look for extra data beside the checkout, so it is beside the copy as well
  [ ! -e ../shared ] || ln -sfn "$(realpath ../shared)" build/faults/shared
}

# fault_build KIND TARGET...: KIND is plain, asan or tsan; optimised like the sanitizers' builds, which compile faster;
# within the copy, where the program finds its data
fault_build() {
  local kind=$1 folder=$PWD/$copy/build/$1 options=()
  shift
  case $kind in
    asan) options=(-DLIMBER_SANITIZE=address "-DCMAKE_CXX_COMPILER=$(clang)") ;;
    tsan) options=(-DLIMBER_SANITIZE=thread) ;;
  esac
  if [ ! -e "$folder/build.ninja" ]; then
    cmake -S "$copy" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Sanitize "${options[@]}" || return
  fi
  cmake --build "$folder" -j "$(jobs)" --target "$@"
}

# words "kind:target" of an expect line: "test_sim tsan:test_base" gives "plain:test_sim tsan:test_base";
# "valgrind:joints" is a scene of tests/memory
expected() { local word; for word in $(fault_line "$1" expect); do case $word in *:*) echo "$word" ;; *) echo "plain:$word" ;; esac; done; }

# each kind once, with its targets behind it
build_expected() {
  local kind rc=0
  for kind in $(cut -d: -f1 <<<"$1" | sort -u); do
    case $kind in
      valgrind) fault_build plain limber || rc=1 ;;
      *) fault_build "$kind" $(sed -n "s/^$kind://p" <<<"$1" | sort -u) || rc=1 ;;
    esac
  done
  return $rc
}

# green WORD FILTER: runs that test program until its first failure, or plays that scene under valgrind
green() {
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

row() { printf '%-34s %-9s %s\n' "$@" | tee -a "$table"; }

# try_fault PATCH: red is the wanted answer
try_fault() {
  local patch=$1 name words word log verdict=green
  name=$(basename "$patch" .patch)
  log=build/check/fault_$name.log
  words=$(expected "$patch")
  if ! git -C "$copy" apply --recount "$PWD/$patch" >"$log" 2>&1; then
    failed=$((failed + 1)); row "$name" "STALE" "the patch does not apply: make it again"; return
  fi
  if ! build_expected "$words" >>"$log" 2>&1; then
    verdict=broken
  else
    for word in $words; do
      green "$word" "$(fault_line "$patch" filter)" >>"$log" 2>&1 || { verdict=red; break; }
    done
  fi
  git -C "$copy" apply -R --recount "$PWD/$patch"
  case $verdict in
    red) pass; row "$name" red "$word: $(grep -m1 -oE 'FAILED  \] [A-Za-z0-9_./]+|SUMMARY: .*|timed out|uninitialised value' "$log" | sed 's/FAILED  \] //' || true)" ;;
    green) failed=$((failed + 1)); row "$name" GREEN "no test noticed: $(fault_line "$patch" fault)" ;;
    broken) failed=$((failed + 1)); row "$name" BROKEN "it does not compile, so it proves nothing ($log)" ;;
  esac
}

# faults NAME...: all, or those whose names start with one of these
faults() {
  local patches=() patch name words word log=build/check/fault_baseline.log
  sanitizer_options
  : >"$table"
  for name in "${@:-}"; do
    for patch in tests/faults/"$name"*.patch; do [ -e "$patch" ] && patches+=("$patch"); done
  done
  [ ${#patches[@]} != 0 ] || refuse 2 "no fault's name starts with '${*:-}'." "ls tests/faults shows them."
  for patch in "${patches[@]}"; do
    [ -n "$(fault_line "$patch" expect)" ] ||
      refuse 2 "$patch does not say which tests it should turn red." "its first line is like: # expect: test_sim"
  done
  renew_copy
  # without the faults all is green, or red would mean nothing
  words=$(for patch in "${patches[@]}"; do expected "$patch"; done | sort -u)
  say "building the tests without a fault: $(tr '\n' ' ' <<<"$words")"
  build_expected "$words" >"$log" 2>&1 || { fail "the build without a fault" "$log"; return; }
  for word in $words; do
    green "$word" >>"$log" 2>&1 || { fail "$word is red without a fault" "$log"; return; }
  done
  row fault verdict "by"
  for patch in "${patches[@]}"; do try_fault "$patch"; done
  say "the table is in $table"
}
