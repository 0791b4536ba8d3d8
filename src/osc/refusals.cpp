// The kernel's error queue (ip(7), IP_RECVERR).
#include "osc/refusals.h"

#include <netinet/in.h>
#include <sys/socket.h>
// behind the others: it takes their types
#include <linux/errqueue.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/log.h"

namespace limber {

namespace {

constexpr int kMostAtOnce = 64;

// the error of one that came back, 0 where it is something else
int error_of(msghdr& message) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != IPPROTO_IP || c->cmsg_type != IP_RECVERR) continue;
    sock_extended_err said{};
    std::memcpy(&said, CMSG_DATA(c), sizeof said);
    if (said.ee_origin == SO_EE_ORIGIN_ICMP) return static_cast<int>(said.ee_errno);
  }
  return 0;
}

}  // namespace

void Refusals::want(int fd) {
  const int on = 1;
  setsockopt(fd, IPPROTO_IP, IP_RECVERR, &on, sizeof on);
}

bool Refusals::tells_of_earlier(int error) {
  return error == ECONNREFUSED || error == EHOSTUNREACH || error == ENETUNREACH;
}

void Refusals::take(int fd, Counters& counters, std::int64_t now) {
  struct alignas(cmsghdr) Control {
    std::array<char, 256> bytes;
  };
  for (int i = 0; i < kMostAtOnce; i++) {
    Control control;
    sockaddr_in to{};
    char nothing = 0;
    iovec piece{&nothing, sizeof nothing};
    msghdr message{};
    message.msg_name = &to;
    message.msg_namelen = sizeof to;
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    message.msg_control = control.bytes.data();
    message.msg_controllen = control.bytes.size();
    if (recvmsg(fd, &message, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) return;
    const int error = error_of(message);
    if (error == 0) continue;
    counters.unsent.fetch_add(1, std::memory_order_relaxed);
    note(endpoint_of(to), error, now);
  }
}

void Refusals::note(const Endpoint& end, int error, std::int64_t now) {
  const auto known = last_.find(end);
  const bool again = known != last_.end() && now - known->second < kPause;
  if (known == last_.end() && last_.size() >= kMost)
    last_.erase(std::ranges::min_element(last_, {}, [](const auto& entry) { return entry.second; }));
  last_[end] = now;
  if (again) return;
  const std::string why = error == ECONNREFUSED ? "nobody listens there" : std::generic_category().message(error);
  log_info("OSC out {}: {}; it is sent to all the same", endpoint_text(end), why);
}

}  // namespace limber
