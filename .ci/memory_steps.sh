# shellcheck shell=bash disable=SC2046,SC2086,SC2154
# Tests for uninitialized memory: the scenes of tests/memory under valgrind, in builds that initialize locals differently,
# and in twenty processes each. (glm could initialize its types with GLM_FORCE_CTOR_INIT, but then its copy constructors
# are not trivial, and checkpoints copy vectors as bytes.)

# Prints the scenes with their options, one per line: NAME SCENE OPTION...
memory_scenes() {
  cat <<'TEXT'
joints tests/memory/joints.lua
contacts tests/memory/contacts.lua
joints_iterative tests/memory/joints.lua --set /scene/iterative=1
contacts_iterative tests/memory/contacts.lua --set /scene/iterative=1
TEXT
}

# The same with several threads, and the scenes in scripts/.
more_memory_scenes() {
  local scene
  echo joints_threads tests/memory/joints.lua --threads 2
  echo contacts_threads tests/memory/contacts.lua --threads 2
  for scene in scripts/*.lua; do echo "$(basename "$scene" .lua) $scene"; done
}

# Builds the program that plays them.
build_program() { configure release build -DLIMBER_TESTS=ON -DLIMBER_BENCHMARKS=ON && build build limber; }

# play_scene TICKS SCENE OPTION...: prints state hashes; `before` is a command prefix.
play_scene() {
  local ticks=$1
  shift
  timeout -k 10 1200 $before "${program:-build/limber}" play "$@" --ticks "$ticks" --fast --hash \
    --osc-in off --osc-out off --query off </dev/null 2>"${errors:-/dev/null}"
}

# memcheck_scene TICKS NAME SCENE OPTION...: plays under valgrind; writes a log and the exit code (9: errors found).
memcheck_scene() {
  local ticks=$1 log=build/check/valgrind_$2.log
  shift 2
  before="valgrind -q --smc-check=all-non-file --error-exitcode=9 --suppressions=tests/valgrind.supp" \
    errors=$log play_scene "$ticks" "$@" >"${log%.log}.out"
  echo $? >"${log%.log}.end"
}

# memcheck_scenes TICKS: plays the scenes from standard input under valgrind, one per core.
memcheck_scenes() {
  local scenes name rest rc begin=$SECONDS
  scenes=$(cat)
  export -f play_scene memcheck_scene
  xargs -P "$(jobs)" -L 1 bash -c 'memcheck_scene "$@"' memcheck "$1" <<<"$scenes"
  while read -r name rest; do
    rc=none
    read -r rc <"build/check/valgrind_$name.end"
    if [ "$rc" = 0 ]; then pass; else
      fail "valgrind on $rest ended with code $rc (9: errors)" "build/check/valgrind_$name.log"
    fi
  done <<<"$scenes"
  say "valgrind: $(wc -l <<<"$scenes") scenes of $1 ticks in $((SECONDS - begin)) s"
}

# --long valgrind: memcheck on every scene of tests/memory and scripts
long_valgrind() {
  build_program || return
  memcheck_scenes 120 < <(memory_scenes; more_memory_scenes)
}

# --long init: builds that initialize locals with zeros or with a pattern must move like the release build
long_init() {
  local fill folder name rest expected
  build_program || return
  for fill in zero pattern; do
    folder=build/init_$fill
    mkdir -p "$folder"
    cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Sanitize -DLIMBER_UNITY=ON -DLIMBER_TESTS=OFF \
      -DCMAKE_CXX_FLAGS="-ftrivial-auto-var-init=$fill" >"$folder/configure.log" 2>&1
    build "$folder" limber || continue
    while read -r name rest; do
      expected=$(play_scene 120 $rest)
      if [ -n "$expected" ] && [ "$(program=$folder/limber play_scene 120 $rest)" = "$expected" ]; then pass; else
        fail "$rest moves differently with -ftrivial-auto-var-init=$fill: a variable is read before it is written"
      fi
    done < <(memory_scenes)
  done
}

# one_of_twenty NUMBER OPTION...: plays 41 ticks with a different memory layout and fill pattern, and prints a hash.
one_of_twenty() {
  local number=$1
  shift
  {
    MALLOC_PERTURB_=$((number * 12)) PADDING=$(printf "%$((number * 97))s") \
      play_scene 41 "$@" --threads $((number % 3 + 1)) || echo "process $number ended with code $?"
  } | md5sum
}

# twenty NAME SCENE OPTION...: checks that twenty processes with 1 to 3 threads have the same hash.
twenty() {
  local name=$1 hashes
  shift
  hashes=$(seq 20 | xargs -P "$(jobs)" -I NUMBER bash -c 'one_of_twenty "$@"' twenty NUMBER "$@" | sort | uniq -c)
  if [ "$(wc -l <<<"$hashes")" = 1 ]; then pass; else
    fail "$name: twenty processes gave different hashes:"$'\n'"$hashes"
  fi
}

# --long twenty: twenty processes have equal hashes, for each joint type in each use, and for contacts
long_twenty() {
  local case name rest
  build_program || return
  export -f play_scene one_of_twenty
  while read -r case name; do
    twenty "$name" tests/memory/joints.lua --set "/scene/case=$case"
  done < <(play_scene 200 tests/memory/joints.lua | awk 'NF == 3 && !known[$2]++ { print ++n, $2 }')
  while read -r name rest; do twenty "$name" $rest; done < <(memory_scenes)
}

# --long models: 10000 random scenes of each kind, played twice, and 200 of them under valgrind
long_models() {
  local log=build/check/valgrind_models.log rc
  build_program && build build test_sim || return
  LIMBER_RANDOM_MODELS=10000 test_seconds=3600 test_only='RandomModels.*' run_tests build sim
  LIMBER_RANDOM_MODELS=200 timeout -k 10 3600 valgrind -q --smc-check=all-non-file --error-exitcode=9 \
    --suppressions=tests/valgrind.supp build/test_sim --gtest_filter=RandomModels.NoSceneGainsEnergy >"$log" 2>&1
  rc=$?
  if [ "$rc" = 0 ]; then pass; else fail "valgrind on 200 random scenes ended with code $rc (9: errors)" "$log"; fi
}
