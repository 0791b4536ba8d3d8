// Receives datagrams in batches with recvmmsg().
#include <array>
#include <cstring>
#include <fstream>
#include <vector>

#include "base/system/net/socket_address.h"
#include "base/system/net/udp_socket.h"

namespace limber::system {

namespace {
constexpr std::size_t kDatagram = 65536;  // more than the UDP maximum, so nothing is truncated
}  // namespace

struct DatagramReader::Buffers {
  std::vector<char> bytes = std::vector<char>(kMaxBatch * kDatagram);
  std::array<iovec, kMaxBatch> pieces{};
  std::array<SocketAddress, kMaxBatch> from{};
  std::array<mmsghdr, kMaxBatch> headers{};
  struct alignas(cmsghdr) Control {
    std::array<char, 64> bytes;
  };
  std::array<Control, kMaxBatch> control{};
  std::array<Datagram, kMaxBatch> datagrams{};

  // The kernel overwrites the lengths, so they are set before each call.
  void prepare() {
    for (std::size_t i = 0; i < kMaxBatch; i++) {
      pieces[i] = {bytes.data() + i * kDatagram, kDatagram};
      msghdr& h = headers[i].msg_hdr;
      h = {};
      h.msg_name = from[i].get();
      h.msg_namelen = SocketAddress::kMaxLength;
      h.msg_iov = &pieces[i];
      h.msg_iovlen = 1;
      h.msg_control = control[i].bytes.data();
      h.msg_controllen = control[i].bytes.size();
    }
  }

  std::optional<std::uint32_t> dropped(std::size_t i) {
    std::optional<std::uint32_t> count;
    msghdr& header = headers[i].msg_hdr;
    for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
      if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SO_RXQ_OVFL) continue;
      std::uint32_t drops = 0;
      std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
      count = drops;
    }
    return count;
  }
};

DatagramReader::DatagramReader() : buffers_(std::make_unique<Buffers>()) {}
DatagramReader::~DatagramReader() = default;

std::span<const Datagram> DatagramReader::read(int fd) {
  Buffers& b = *buffers_;
  b.prepare();
  const int count = recvmmsg(fd, b.headers.data(), kMaxBatch, MSG_DONTWAIT, nullptr);
  if (count <= 0) return {};
  const auto got = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < got; i++) {
    b.datagrams[i] = {static_cast<const char*>(b.pieces[i].iov_base), b.headers[i].msg_len, b.from[i].endpoint(),
                      b.dropped(i)};
  }
  return std::span(b.datagrams).first(got);
}

void count_dropped(int fd) {
  const int on = 1;
  setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
}

int set_receive_buffer(int fd, int bytes) {
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  int granted = 0;
  socklen_t length = sizeof granted;
  getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &length);
  return granted / 2;  // the kernel doubles the value for its own overhead
}

std::optional<long> max_receive_buffer() {
  std::ifstream file("/proc/sys/net/core/rmem_max");
  long number = 0;
  if (!(file >> number)) return std::nullopt;
  return number;
}

}  // namespace limber::system
