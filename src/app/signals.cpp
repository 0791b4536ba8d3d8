// Blocked in every thread, since threads that start later inherit it.
#include "app/signals.h"

#include <ctime>
#include <initializer_list>

namespace limber {

sigset_t block_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told as a full disk is
  return set;
}

bool signal_came(const sigset_t& signals) {
  const timespec now = {0, 0};
  return sigtimedwait(&signals, nullptr, &now) > 0;
}

}  // namespace limber
