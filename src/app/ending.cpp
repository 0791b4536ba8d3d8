// A thread that looks about itself every twenty milliseconds.
#include "app/ending.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "app/exit_code.h"

namespace limber {

namespace {
constexpr timespec kLook = {0, 20'000'000};
constexpr int kMostLooks = 25;
/// After another signal: it may have come with the first, as to a program and to its group.
constexpr int kLooksMore = 12;
}  // namespace

Ending::Ending(const sigset_t& signals, std::function<void()> late)
    : signals_(signals), late_(std::move(late)), thread_([this] { watch(); }) {}

Ending::~Ending() {
  done_.store(true);
  thread_.join();
}

void Ending::watch() {
  bool asked = false;
  for (int looks = 0, more = 0; !done_.load();) {
    const int signal = sigtimedwait(&signals_, nullptr, &kLook);
    if (done_.load()) return;
    asked = asked || (signal > 0 && signal != SIGUSR1);
    if (asked && ++more > kLooksMore) {
      std::fputs("limber: ended before all files were written\n", stderr);
      std::_Exit(kInput);
    }
    if (whole_.load() && ++looks > kMostLooks) late_();
  }
}

}  // namespace limber
