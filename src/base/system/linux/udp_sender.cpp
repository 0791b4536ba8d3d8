// Sends batches with sendmmsg() and UDP segmentation; reads undelivered datagrams from the error queue (IP_RECVERR).
// A socket of IPv6 is opened when a datagram is sent to such an address.
#include <netinet/udp.h>

#include "base/system/net/socket_address.h"
#include "base/system/net/udp_socket.h"
// after the others, because it uses their types
#include <linux/errqueue.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace limber::system {

namespace {

constexpr std::size_t kCalls = 32;        // messages of one sendmmsg
constexpr std::size_t kSegments = 64;     // the kernel's limit
constexpr std::size_t kRunBytes = 65000;  // the kernel's limit for a piece

struct Call {
  std::array<mmsghdr, kCalls> headers{};
  std::array<iovec, kCalls> pieces{};
  std::array<std::size_t, kCalls> datagrams{};
  struct alignas(cmsghdr) Control {
    std::array<char, CMSG_SPACE(sizeof(std::uint16_t))> bytes{};
  };
  std::array<Control, kCalls> control{};
};

// Returns the number of datagrams from `first` on that can be sent in one piece.
std::size_t run_length(std::span<const std::uint32_t> sizes, std::size_t first, bool segmentation) {
  if (!segmentation) return 1;
  const std::uint32_t size = sizes[first];
  std::size_t count = 1;
  while (count < kSegments && first + count < sizes.size() && sizes[first + count] == size &&
         (count + 1) * size <= kRunBytes) {
    count++;
  }
  return count;
}

void add_piece(Call& call, std::size_t i, const SocketAddress& to, const char* data, std::size_t bytes,
               std::size_t datagrams) {
  call.pieces[i] = {const_cast<char*>(data), bytes};
  call.datagrams[i] = datagrams;
  msghdr& h = call.headers[i].msg_hdr;
  h = {};
  h.msg_name = const_cast<sockaddr*>(to.get());
  h.msg_namelen = to.length();
  h.msg_iov = &call.pieces[i];
  h.msg_iovlen = 1;
  if (datagrams == 1) return;
  h.msg_control = call.control[i].bytes.data();
  h.msg_controllen = call.control[i].bytes.size();
  cmsghdr* c = CMSG_FIRSTHDR(&h);
  c->cmsg_level = SOL_UDP;
  c->cmsg_type = UDP_SEGMENT;
  c->cmsg_len = CMSG_LEN(sizeof(std::uint16_t));
  const auto size = static_cast<std::uint16_t>(bytes / datagrams);
  std::memcpy(CMSG_DATA(c), &size, sizeof size);
}

// True if the error means that the route does not support segmentation.
bool segmentation_unsupported(int error) {
  return error == EIO || error == EINVAL || error == EMSGSIZE || error == ENOPROTOOPT || error == EOPNOTSUPP;
}

BatchResult send_batch(int fd, const Endpoint& to, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                       bool& segmentation) {
  const SocketAddress address(to);
  Call call;
  BatchResult result;
  std::size_t at = 0;  // bytes before datagram `result.sent`
  std::optional<std::size_t> again;
  while (result.sent < sizes.size()) {
    std::size_t count = 0;
    std::size_t next = result.sent;
    for (std::size_t offset = at; count < kCalls && next < sizes.size(); count++) {
      const std::size_t run = run_length(sizes, next, segmentation);
      add_piece(call, count, address, bytes.data() + offset, run * sizes[next], run);
      offset += run * sizes[next];
      next += run;
    }
    const int done = sendmmsg(fd, call.headers.data(), static_cast<unsigned>(count), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (done < 0) {
      if (errno == EINTR) continue;
      if (may_report_earlier_datagram(errno) && again != result.sent) {
        again = result.sent;
        continue;
      }
      if (call.datagrams[0] > 1 && segmentation_unsupported(errno)) {
        segmentation = false;
        continue;
      }
      result.error = errno;
      return result;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(done); i++) {
      at += call.pieces[i].iov_len;
      result.sent += call.datagrams[i];
    }
  }
  return result;
}

// Returns the error of an undelivered datagram, or 0 for other messages.
int error_of(msghdr& message) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    const bool ipv4 = c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_RECVERR;
    const bool ipv6 = c->cmsg_level == IPPROTO_IPV6 && c->cmsg_type == IPV6_RECVERR;
    if (!ipv4 && !ipv6) continue;
    sock_extended_err report{};
    std::memcpy(&report, CMSG_DATA(c), sizeof report);
    if (report.ee_origin == SO_EE_ORIGIN_ICMP || report.ee_origin == SO_EE_ORIGIN_ICMP6)
      return static_cast<int>(report.ee_errno);
  }
  return 0;
}

}  // namespace

struct UdpSender::State {
  int send_buffer = 0;
  int receive_buffer = 0;
  UdpSocket ipv4, ipv6;

  Result<UdpSocket> open_any(bool is_v6) const {
    Result<UdpSocket> socket = open_udp({is_v6 ? IpAddress(0, 0) : IpAddress(), 0});
    if (!socket) return socket;
    if (send_buffer > 0) set_send_buffer(socket->fd(), send_buffer);
    if (receive_buffer > 0) set_receive_buffer(socket->fd(), receive_buffer);
    allow_broadcast(socket->fd());
    enable(socket->fd(), is_v6 ? IPPROTO_IPV6 : IPPROTO_IP, is_v6 ? IPV6_RECVERR : IP_RECVERR);
    return socket;
  }

  // Returns -1 if this machine has no IPv6.
  int socket_to(const Endpoint& to) {
    if (!to.ip.is_v6) return ipv4.fd();
    if (!ipv6.is_open()) {
      Result<UdpSocket> socket = open_any(true);
      if (socket) ipv6 = std::move(*socket);
    }
    return ipv6.fd();
  }
};

UdpSender::UdpSender() = default;
UdpSender::~UdpSender() = default;
UdpSender::UdpSender(UdpSender&&) noexcept = default;
UdpSender& UdpSender::operator=(UdpSender&&) noexcept = default;

Result<void> UdpSender::open(int send_buffer, int receive_buffer) {
  State state{send_buffer, receive_buffer, {}, {}};
  Result<UdpSocket> socket = state.open_any(false);
  if (!socket) return Error{socket.error()};
  state.ipv4 = std::move(*socket);
  state_ = std::make_unique<State>(std::move(state));
  return {};
}

void UdpSender::close() { state_.reset(); }

int UdpSender::send(const Endpoint& to, std::span<const char> packet) {
  if (state_ == nullptr) return EBADF;
  const int fd = state_->socket_to(to);
  return fd < 0 ? EAFNOSUPPORT : send_datagram(fd, to, packet);
}

BatchResult UdpSender::send(const Endpoint& to, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                            bool& segmentation) {
  if (state_ == nullptr) return {0, EBADF};
  const int fd = state_->socket_to(to);
  return fd < 0 ? BatchResult{0, EAFNOSUPPORT} : send_batch(fd, to, bytes, sizes, segmentation);
}

std::optional<SendFailure> UdpSender::next_failure() {
  if (state_ == nullptr) return std::nullopt;
  for (const UdpSocket* const socket : {&state_->ipv4, &state_->ipv6}) {
    while (socket->is_open()) {
      struct alignas(cmsghdr) Control {
        std::array<char, 256> bytes;
      };
      Control control;
      SocketAddress to;
      char nothing = 0;
      iovec piece{&nothing, sizeof nothing};
      msghdr message{};
      message.msg_name = to.get();
      message.msg_namelen = SocketAddress::kMaxLength;
      message.msg_iov = &piece;
      message.msg_iovlen = 1;
      message.msg_control = control.bytes.data();
      message.msg_controllen = control.bytes.size();
      if (recvmsg(socket->fd(), &message, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) break;
      if (const int error = error_of(message); error != 0) return SendFailure{to.endpoint(), error};
    }
  }
  return std::nullopt;
}

}  // namespace limber::system
