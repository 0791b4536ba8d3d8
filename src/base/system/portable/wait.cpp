// Waits with pselect(), which has nanosecond timeouts and signals but requires descriptors below FD_SETSIZE. For others
// uses poll(), in milliseconds and without unblocking signals.
#include "base/system/wait.h"

#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>
#include <sys/select.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace limber::system {

namespace {

bool wait_by_poll(std::span<PollEntry> list, std::optional<std::chrono::nanoseconds> limit) {
  std::vector<pollfd> polled;
  for (const PollEntry& w : list)
    polled.push_back({w.fd, static_cast<short>((w.read ? POLLIN : 0) | (w.write ? POLLOUT : 0)), 0});
  int ms = -1;
  if (limit) {
    const auto up = std::chrono::ceil<std::chrono::milliseconds>(*limit).count();
    ms = static_cast<int>(std::clamp<std::int64_t>(up, 0, 1'000'000));
  }
  if (poll(polled.data(), static_cast<nfds_t>(polled.size()), ms) <= 0) return false;
  for (std::size_t i = 0; i < list.size(); i++) list[i].ready = polled[i].revents != 0;
  return true;
}

bool wait(std::span<PollEntry> list, std::optional<std::chrono::nanoseconds> limit, const sigset_t* signals) {
  fd_set readable;
  fd_set writable;
  FD_ZERO(&readable);
  FD_ZERO(&writable);
  int end = 0;
  for (PollEntry& w : list) {
    w.ready = false;
    end = std::max(end, w.fd + 1);
  }
  if (end > FD_SETSIZE) return wait_by_poll(list, limit);
  for (const PollEntry& w : list) {
    if (w.fd >= 0 && w.read) FD_SET(w.fd, &readable);
    if (w.fd >= 0 && w.write) FD_SET(w.fd, &writable);
  }
  timespec time{};
  if (limit) {
    const std::int64_t ns = std::max<std::int64_t>(0, limit->count());
    time.tv_sec = ns / 1'000'000'000;
    time.tv_nsec = ns % 1'000'000'000;
  }
  if (pselect(end, &readable, &writable, nullptr, limit ? &time : nullptr, signals) <= 0) return false;
  for (PollEntry& w : list) w.ready = w.fd >= 0 && (FD_ISSET(w.fd, &readable) || FD_ISSET(w.fd, &writable));
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
