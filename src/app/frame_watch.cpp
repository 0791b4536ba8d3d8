// It looks every fifty milliseconds.
#include "app/frame_watch.h"

#include <chrono>
#include <utility>

#include "base/system/standard_output.h"
#include "base/system/thread.h"

namespace limber {

namespace {
constexpr auto kFrameLook = std::chrono::milliseconds(50);
constexpr int kFrameLooks = 20;
}  // namespace

FrameWatch::~FrameWatch() {
  done_.store(true);
  turn_.unlock();
  if (thread_.joinable()) thread_.join();
}

void FrameWatch::start(std::function<void()> end) {
  end_ = std::move(end);
  (void)system::start_thread(thread_, [this] { watch(); });
}

void FrameWatch::watch() {
  system::name_this_thread("limber-frames");
  for (int looks = 0; !done_.load();) {
    std::this_thread::sleep_for(kFrameLook);
    looks = ending_.load() || system::end_is_pending() ? looks + 1 : 0;
    if (looks < kFrameLooks || !turn_.try_lock()) continue;
    // the main thread stays where it is, since this one keeps the turn
    if (!done_.load()) end_();
    turn_.unlock();
  }
}

}  // namespace limber
