// Waits with ppoll(): nanosecond timeouts, any number of descriptors, and signals.
#include "base/system/wait.h"

#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>

#include <algorithm>
#include <array>
#include <ctime>
#include <vector>

namespace limber::system {

namespace {

bool wait(std::span<PollEntry> list, std::optional<std::chrono::nanoseconds> limit, const sigset_t* signals) {
  std::array<pollfd, 16> few;
  std::vector<pollfd> many(list.size() > few.size() ? list.size() : 0);
  pollfd* const polled = many.empty() ? few.data() : many.data();
  for (std::size_t i = 0; i < list.size(); i++) {
    const int events = (list[i].read ? POLLIN : 0) | (list[i].write ? POLLOUT : 0);
    polled[i] = {list[i].fd, static_cast<short>(events), 0};
    list[i].ready = false;
  }
  timespec time{};
  if (limit) {
    const std::int64_t ns = std::max<std::int64_t>(0, limit->count());
    time = {ns / 1'000'000'000, ns % 1'000'000'000};
  }
  if (ppoll(polled, list.size(), limit ? &time : nullptr, signals) <= 0) return false;
  for (std::size_t i = 0; i < list.size(); i++) list[i].ready = polled[i].revents != 0;
  return true;
}

}  // namespace

bool wait_ready(std::span<PollEntry> list, std::optional<std::chrono::nanoseconds> limit) {
  return wait(list, limit, nullptr);
}

bool wait_ready_or_signal(std::span<PollEntry> list, std::optional<std::chrono::nanoseconds> limit) {
  sigset_t none;
  sigemptyset(&none);
  return wait(list, limit, &none);
}

}  // namespace limber::system
