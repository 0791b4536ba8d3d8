# shellcheck shell=bash disable=SC2046,SC2086
# The portable build: base/system with POSIX calls only, as on systems other than Linux.

# --long portable: all tests in a build that uses POSIX calls only; checks that it uses no others
long_portable() {
  local holder calls='eventfd|inotify_|recvmmsg|sendmmsg|epoll_|timerfd_|signalfd|accept4|pipe2|ppoll|sigtimedwait|mallinfo'
  configure release build/portable -B build/portable -DLIMBER_PORTABLE=ON -DLIMBER_TESTS=ON -DLIMBER_BENCHMARKS=OFF
  build build/portable all test_bench || return
  if nm -D --undefined-only build/portable/limber | grep -E " ($calls)" >build/check/portable_calls.log; then
    fail "build/portable/limber makes calls that only Linux has" build/check/portable_calls.log
  else
    pass
  fi
  exec {holder}> >(exec python3 .ci/hold_ports.py)
  run_tests build/portable $(test_modules long)
  exec {holder}>&-
}
