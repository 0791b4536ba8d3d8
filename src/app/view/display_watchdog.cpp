// A watchdog thread that polls every fifty milliseconds.
#include "app/view/display_watchdog.h"

#include <chrono>
#include <utility>

#include "base/system/standard_output.h"
#include "base/system/thread.h"

namespace limber::app {

namespace {
constexpr auto kFramePollInterval = std::chrono::milliseconds(50);
constexpr int kMaxFramePolls = 20;
}  // namespace

DisplayWatchdog::~DisplayWatchdog() {
  done_.store(true);
  main_thread_mutex_.unlock();
  if (thread_.joinable()) thread_.join();
}

void DisplayWatchdog::start(std::function<void()> end) {
  end_ = std::move(end);
  (void)system::start_thread(thread_, [this] { watch(); });
}

void DisplayWatchdog::watch() {
  system::name_this_thread("limber-display");
  for (int polls = 0; !done_.load();) {
    std::this_thread::sleep_for(kFramePollInterval);
    polls = ending_.load() || system::termination_is_pending() ? polls + 1 : 0;
    if (polls < kMaxFramePolls || !main_thread_mutex_.try_lock()) continue;
    // this thread holds the mutex, so the main thread can't return from call()
    if (!done_.load()) end_();
    main_thread_mutex_.unlock();
  }
}

}  // namespace limber::app
