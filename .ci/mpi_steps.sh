# shellcheck shell=bash
# The long part "mpi": sweeps and searches over the ranks of MPI jobs.

# --long mpi: sweep and evolve with Open MPI, MPICH and a Slurm of one node: equal results, killed children and ranks; load
long_mpi() {
  local log=build/check/mpi.log line
  need_packages mpi
  tests_at_length 'LongMpi.*'
  build build limber || return
  tests/mpi/run build/limber >"$log" 2>&1
  while read -r line; do
    case $line in
      "ok "*) pass ;;
      "FAILED "*) fail "mpi: ${line#FAILED }" ;;
      "left out: "*) say "$line" ;;
    esac
  done <"$log"
  grep -qE '^(ok|left out)' "$log" || fail "tests/mpi/run ended early" "$log"
  say "mpi: $(grep -c '^ok ' "$log") checks passed (output: $log)"
}
