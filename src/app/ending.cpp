// A thread that looks about itself every twenty milliseconds.
#include "app/ending.h"

#include <utility>

#include "app/exit_code.h"
#include "base/output.h"
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
    if (signal == system::Signal::end) {
      asked = true;
      hurry_output();
    }
    if (done_.load()) return;
    if (asked && ++more > kLooksMore) {
      print_notice("ended before all files were written");
      end_program(kInput);
    }
    if (whole_.load() && ++looks > kMostLooks) late_();
  }
}

}  // namespace limber
