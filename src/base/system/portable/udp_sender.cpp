// Sends with one connected socket per target, because POSIX reports undelivered datagrams only to connected sockets, at
// the next send. Therefore each target gets its datagrams from a different port, and an unreachable target is detected
// one datagram later than on Linux.
#include <array>
#include <cerrno>
#include <deque>
#include <map>

#include "base/system/net/socket_address.h"
#include "base/system/net/udp_socket.h"
#include "base/system/open.h"

namespace limber::system {

namespace {

constexpr std::size_t kMaxSockets = 128;    // more targets close the least recently used socket
constexpr std::size_t kMaxFailures = 1024;  // pending reports for next_failure()

}  // namespace

struct UdpSender::State {
  struct Connection {
    Descriptor socket;
    std::uint64_t used = 0;
  };
  int send_buffer = 0;
  int receive_buffer = 0;
  std::uint64_t uses = 0;
  std::map<Endpoint, Connection> connections;
  std::deque<SendFailure> failures;

  // Returns the socket of a target, or -1 with errno set.
  int socket_to(const Endpoint& to) {
    auto known = connections.find(to);
    if (known == connections.end()) {
      const SocketAddress address(to);
      Descriptor socket = open_socket(address.family(), SOCK_DGRAM);
      if (!socket.is_open()) return -1;
      if (send_buffer > 0) set_send_buffer(socket.fd(), send_buffer);
      if (receive_buffer > 0) set_receive_buffer(socket.fd(), receive_buffer);
      allow_broadcast(socket.fd());
      if (connect(socket.fd(), address.get(), address.length()) != 0) return -1;
      if (connections.size() >= kMaxSockets) close_oldest();
      known = connections.emplace(to, Connection{std::move(socket), 0}).first;
    }
    known->second.used = ++uses;
    return known->second.socket.fd();
  }

  void close_oldest() {
    auto oldest = connections.begin();
    for (auto at = connections.begin(); at != connections.end(); ++at) {
      if (at->second.used < oldest->second.used) oldest = at;
    }
    connections.erase(oldest);
  }
};

UdpSender::UdpSender() = default;
UdpSender::~UdpSender() = default;
UdpSender::UdpSender(UdpSender&&) noexcept = default;
UdpSender& UdpSender::operator=(UdpSender&&) noexcept = default;

Result<void> UdpSender::open(int send_buffer, int receive_buffer) {
  state_ = std::make_unique<State>();
  state_->send_buffer = send_buffer;
  state_->receive_buffer = receive_buffer;
  return {};
}

void UdpSender::close() { state_.reset(); }

int UdpSender::send(const Endpoint& to, std::span<const char> packet) {
  if (state_ == nullptr) return EBADF;
  if (to.port == 0) return EINVAL;  // connect() accepts port 0
  const int fd = state_->socket_to(to);
  if (fd < 0) return errno;
  const auto send = [&] { return ::send(fd, packet.data(), packet.size(), MSG_DONTWAIT | kNoSignal) >= 0; };
  if (send()) return 0;
  const int error = errno;
  if (!may_report_earlier_datagram(error)) return error;
  if (!send()) return errno;
  if (state_->failures.size() < kMaxFailures) state_->failures.push_back({to, error});
  return 0;
}

BatchResult UdpSender::send(const Endpoint& to, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                            bool& segmentation) {
  segmentation = false;
  BatchResult result;
  for (const std::uint32_t size : sizes) {
    result.error = send(to, bytes.first(size));
    if (result.error != 0) break;
    bytes = bytes.subspan(size);
    result.sent++;
  }
  return result;
}

std::optional<SendFailure> UdpSender::next_failure() {
  if (state_ == nullptr || state_->failures.empty()) return std::nullopt;
  const SendFailure first = state_->failures.front();
  state_->failures.pop_front();
  return first;
}

}  // namespace limber::system
