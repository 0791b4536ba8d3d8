// Signals of POSIX.
#include "base/system/signals.h"

#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>
#include <sys/time.h>

#include <initializer_list>

#include "base/system/blocked_signals.h"
#include "base/system/thread.h"

namespace limber::system {

sigset_t blocked_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) sigaddset(&set, signal);
  return set;
}

Signal signal_from_number(int signal) {
  if (signal <= 0) return Signal::none;
  return signal == SIGUSR1 ? Signal::wake : Signal::terminate;
}

void block_signals() {
  const sigset_t set = blocked_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // SIGXFSZ: exceeding the file size limit becomes an error of write(). SIGTTOU, SIGTTIN: sent if another program is in
  // the foreground of the terminal (stty tostop). The others would terminate the program.
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGTTOU, SIGTTIN, SIGALRM, SIGVTALRM, SIGIO}) ::signal(signal, SIG_IGN);
}

void wake_thread(std::uint64_t thread) { signal_thread(thread, SIGUSR1); }

void handle_signal(int signal, SignalHandler handler) {
  struct sigaction action {};
  action.sa_handler = handler;  // without SA_RESTART
  sigaction(signal, &action, nullptr);
}

void handle_signal_immediately(int signal, SignalHandler handler) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  // The C library's function, which sanitizers do not intercept.
  using Function = decltype(&sigaction);
  const auto unwrapped = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "__sigaction"));
  (unwrapped == nullptr ? &sigaction : unwrapped)(signal, &action, nullptr);
}

void on_user_signal(SignalHandler handler) { handle_signal_immediately(SIGUSR2, handler); }

void block_signal(int signal) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void unblock_signal(int signal) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void block_process_signals() {
  sigset_t set;
  sigfillset(&set);
  for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT}) sigdelset(&set, fault);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

namespace {

bool has_handler(int signal, SignalHandler except) {
  struct sigaction action {};
  if (sigaction(signal, nullptr, &action) != 0) return true;
  return action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN && action.sa_handler != except;
}

}  // namespace

int claim_thread_signal(SignalHandler handler) {
  int signal = SIGURG;
#ifdef SIGRTMAX
  if (has_handler(signal, handler)) {
    signal = SIGRTMAX;
    while (signal >= SIGRTMIN && has_handler(signal, handler)) signal--;
    if (signal < SIGRTMIN) return 0;
  }
#endif
  handle_signal_immediately(signal, handler);
  return signal;
}

void release_thread_signal(int signal, SignalHandler handler) {
  struct sigaction action {};
  if (signal != SIGURG || sigaction(signal, nullptr, &action) != 0 || action.sa_handler != handler) return;
  handle_signal_immediately(signal, SIG_DFL);
}

SignalHandler preserve_profile_signal(const std::function<void()>& use) {
  struct sigaction before {};
  struct sigaction profiler {};
  itimerval timer{};
  sigaction(SIGPROF, nullptr, &before);
  getitimer(ITIMER_PROF, &timer);
  use();
  sigaction(SIGPROF, nullptr, &profiler);
  sigaction(SIGPROF, &before, nullptr);
  setitimer(ITIMER_PROF, &timer, nullptr);
  return profiler.sa_handler;
}

}  // namespace limber::system
