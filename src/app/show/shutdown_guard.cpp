// A watchdog thread that polls every twenty milliseconds.
#include "app/show/shutdown_guard.h"

#include <utility>

#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/system/signals.h"

namespace limber::app {

namespace {
constexpr auto kPollInterval = std::chrono::milliseconds(20);
constexpr int kMaxPolls = 25;
/// Grace period after another signal, which may be a duplicate of the first: sent to the program and to its group.
constexpr int kGracePolls = 12;
}  // namespace

ShutdownGuard::ShutdownGuard(std::function<void()> on_timeout)
    : on_timeout_(std::move(on_timeout)), thread_([this] { watch(); }) {}

ShutdownGuard::~ShutdownGuard() {
  done_.store(true);
  thread_.join();
}

void ShutdownGuard::watch() {
  bool signalled = false;
  for (int polls = 0, grace_polls = 0; !done_.load();) {
    const system::Signal signal = system::wait_for_signal(kPollInterval);
    if (signal == system::Signal::terminate) {
      signalled = true;
      begin_output_shutdown();
    }
    if (done_.load()) return;
    if (signalled && ++grace_polls > kGracePolls) {
      print_notice("interrupted before all files were written");
      end_program(kInputError);
    }
    if (files_written_.load() && ++polls > kMaxPolls) on_timeout_();
  }
}

}  // namespace limber::app
