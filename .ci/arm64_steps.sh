# shellcheck shell=bash disable=SC2046,SC2086,SC2154
# arm64: cross-compiled and run with qemu-user in a Debian 12 root.

# in_arm64 PART...: runs parts of .ci/arm64 and counts its tests.
in_arm64() {
  local log=build/check/arm64.log line
  .ci/chroot bookworm --name arm64 --arch arm64 .ci/arm64 "$@" 2>&1 | tee "$log" | grep -E '^arm64: ' || true
  line=$(tail -n 1 "$log")
  [[ $line =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]] || { fail "arm64 $*" "$log"; return 1; }
  pass "${BASH_REMATCH[1]}"
  failed=$((failed + BASH_REMATCH[2]))
}

# Adds a row to the table of ./check --long hashes: the golden scenes with one and two threads.
hash_arm64() {
  local label="Debian 12 (bookworm), arm64, qemu-aarch64"
  if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
    hash_left_out "$label" "it needs root and debootstrap"
    return
  fi
  hash_row "$label" hash_lines_of .ci/chroot bookworm --name arm64 --arch arm64 .ci/arm64 golden
  hash_differs_by_design "$label" "Debian's Bullet for arm64 contains fused multiply-adds, see [arm64](../understand/arm64.md)"
}

# Writes a table with each scene's hash on arm64 and on this machine.
compare_hashes() {
  local name scene played here table=build/check/arm64_hashes.txt
  : >"$table"
  while read -r name scene; do
    played=$(sed -n "s/^played $name //p" build/check/arm64.log)
    here=$(play_scene 300 $scene | tail -1)
    printf '%-22s arm64 %s  here %s  %s\n' "$name" "$played" "$here" "$([ "$played" = "$here" ] && echo same || echo different)" >>"$table"
  done < <(memory_scenes; more_memory_scenes | grep -v threads)
  say "hashes of arm64 and $(uname -m): $table"
}

# --long arm64: a cross-compiled arm64 build: tests of OSC, base, Lua and the command line, and scenes, with qemu-user
long_arm64() {
  in_arm64 build tests play && build_program && compare_hashes
}
# --long arm64_sim: the tests of sim on arm64 with qemu-user
long_arm64_sim() { in_arm64 build sim; }
