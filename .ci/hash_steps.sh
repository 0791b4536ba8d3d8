# shellcheck shell=bash disable=SC2046,SC2086,SC2154
# Compares the golden scenes on all platforms that this machine can build or emulate, in the table of
# docs/reference/hashes.md.

hash_folder=build/check/hashes

# hash_row PLATFORM COMMAND...: plays the scenes by COMMAND, which writes lines to the file in LIMBER_GOLDEN_OUT.
hash_row() {
  local platform=$1 file
  shift
  file=$hash_folder/$(printf '%s' "$platform" | tr -c 'a-zA-Z0-9' _)
  rm -f "$file".*
  printf '%s\n' "$platform" >"$file.name"
  LIMBER_GOLDEN_OUT=$PWD/$file.lines "$@" >"$file.log" 2>&1
  [ -s "$file.lines" ] || printf 'it did not play: %s\n' "$(grep -vE '^\s*$' "$file.log" | tail -n 1 | cut -c1-120)" >"$file.missing"
}

# hash_left_out PLATFORM REASON: records that a platform was skipped.
hash_left_out() {
  local file
  file=$hash_folder/$(printf '%s' "$1" | tr -c 'a-zA-Z0-9' _)
  rm -f "$file".*
  printf '%s\n' "$1" >"$file.name"
  printf '%s\n' "$2" >"$file.missing"
}

# hash_differs_by_design PLATFORM REASON: its hashes may differ from the golden ones, but not between numbers of threads.
hash_differs_by_design() {
  printf '%s\n' "$2" >"$hash_folder/$(printf '%s' "$1" | tr -c 'a-zA-Z0-9' _).own"
}

golden_filter='Scenes/*:GoldenShow.*'
golden_filter_one='Scenes/*_1:GoldenShow.*'

cpu_has() { grep -qw -- "$1" /proc/cpuinfo; }

# hash_build LABEL COMPILER ARCHITECTURE: builds and plays the scenes, as a row of the table.
hash_build() {
  local label=$1 compiler=$2 architecture=$3 folder
  folder=build/hashes/${compiler##*/}_$architecture
  if .ci/golden lines --folder "$folder" --threads 0 -- -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_CXX_FLAGS="-march=$architecture" >"$hash_folder/build.log" 2>&1; then
    hash_row "$label" "$folder/test_golden" --gtest_filter="$golden_filter"
  else
    hash_left_out "$label" "it could not be built: $(tail -n 1 "$hash_folder/build.log" | cut -c1-120)"
  fi
}

hash_compilers() {
  local compiler architecture architectures="x86-64 x86-64-v3" clang
  clang=$(newest clang++)
  if cpu_has avx512f && cpu_has avx512bw && cpu_has avx512dq; then architectures+=" x86-64-v4"; else
    hash_left_out "AVX-512 (-march=x86-64-v4)" "the processor has no AVX-512"
  fi
  for compiler in g++ $clang; do
    for architecture in $architectures; do
      hash_build "$(system_name), $($compiler -dumpversion | sed "s/^/${compiler%%-*} /"), -march=$architecture" \
        "$compiler" "$architecture"
    done
  done
}

# Plays the scenes with another math library or processor.
hash_surroundings() {
  local program=build/test_golden here
  here=$(system_name)
  hash_row "$here, compiled Lua off" env LIMBER_GOLDEN_JIT=off $program --gtest_filter="$golden_filter_one"
  if [ "$(hash_probe)" != "$(GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2 hash_probe)" ]; then
    hash_row "$here, glibc without FMA (GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2)" \
      env GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2 $program --gtest_filter="$golden_filter"
  else
    hash_left_out "glibc without FMA" "GLIBC_TUNABLES changes no result of the math library here"
  fi
  if gcc -O1 -fno-builtin -shared -fPIC -o $hash_folder/other_libm.so .ci/other_libm.c 2>$hash_folder/build.log; then
    hash_row "$here, a math library with results off by one unit (.ci/other_libm.c)" \
      env LD_PRELOAD=$PWD/$hash_folder/other_libm.so $program --gtest_filter="$golden_filter"
  fi
  if command -v qemu-x86_64 >/dev/null; then
    hash_row "$here, qemu-x86_64 -cpu Nehalem (SSE 4.2, neither AVX nor FMA)" \
      qemu-x86_64 -cpu Nehalem $program --gtest_filter="$golden_filter_one"
  else
    hash_left_out "qemu-x86_64 -cpu Nehalem" "qemu-user is not installed"
  fi
}

# Prints a hash of results of the C library's math functions.
hash_probe() {
  local program=$hash_folder/probe
  [ -x $program ] || gcc -O1 -fno-builtin -x c -o $program - -lm <<'TEXT'
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
static uint64_t hash;
static void add(double value) {
  uint64_t bits;
  memcpy(&bits, &value, 8);
  hash = (hash ^ bits) * 1099511628211u;
}
int main(void) {
  for (int i = 1; i < 20000; i++) add(sin(i * 0.0137)), add(exp(i * -1e-3)), add(pow(i, 0.7)), add(log(i)), add(atan(i * 0.1));
  printf("%llx\n", (unsigned long long)hash);
}
TEXT
  $program
}

# hash_lines_of COMMAND...: prints its output and writes its "golden:" lines to LIMBER_GOLDEN_OUT.
hash_lines_of() {
  local all=$LIMBER_GOLDEN_OUT.all
  "$@" >"$all"
  cat "$all"
  sed -nE 's/^golden: ([a-z0-9_.]+ [0-9]+ [0-9a-f]{16} [0-9]+)$/\1/p' "$all" >"$LIMBER_GOLDEN_OUT"
  rm -f "$all"
}

# hash_chroot RELEASE LABEL: builds and plays the scenes in a Debian root.
hash_chroot() {
  local label=$2
  if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
    hash_left_out "$label" "it needs root and debootstrap"
    return
  fi
  hash_row "$label" hash_lines_of .ci/chroot "$1" .ci/golden lines
}

# --long hashes: the golden scenes with each available compiler, processor and release; writes docs/reference/hashes.md
long_hashes() {
  mkdir -p $hash_folder && rm -f $hash_folder/*
  configure release build -DLIMBER_TESTS=ON
  build build test_golden || return
  hash_compilers
  hash_surroundings
  hash_chroot trixie "Debian 13 (trixie)"
  hash_chroot sid "Debian sid"
  hash_arm64
  if python3 .ci/hash_table.py $hash_folder docs/reference/hashes.md >$hash_folder/verdict; then
    pass
  else
    fail "hashes differ: $(tr '\n' ';' <$hash_folder/verdict)"
  fi
  say "$(tail -n 1 $hash_folder/verdict)"
}
