// A thread that looks about itself every twenty milliseconds.
#include "app/ending.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "app/exit_code.h"
#include "base/system/signals.h"

namespace limber {

namespace {
constexpr auto kLook = std::chrono::milliseconds(20);
constexpr int kMostLooks = 25;
/// After another signal: it may have come with the first, as to a program and to its group.
constexpr int kLooksMore = 12;
}  // namespace

Ending::Ending(std::function<void()> late) : late_(std::move(late)), thread_([this] { watch(); }) {}

Ending::~Ending() {
  done_.store(true);
  thread_.join();
}

void Ending::watch() {
  bool asked = false;
  for (int looks = 0, more = 0; !done_.load();) {
    const system::Signal signal = system::wait_for_signal(kLook);
    if (done_.load()) return;
    asked = asked || signal == system::Signal::end;
    if (asked && ++more > kLooksMore) {
      std::fputs("limber: ended before all files were written\n", stderr);
      std::_Exit(kInput);
    }
    if (whole_.load() && ++looks > kMostLooks) late_();
  }
}

}  // namespace limber
