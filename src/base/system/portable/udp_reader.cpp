// Receives datagrams with recvfrom(). POSIX has no count of dropped datagrams and no maximum buffer size.
#include <array>
#include <vector>

#include "base/system/net/socket_address.h"
#include "base/system/net/udp_socket.h"

namespace limber::system {

namespace {
constexpr std::size_t kDatagram = 65536;  // more than the UDP maximum, so nothing is truncated
}  // namespace

struct DatagramReader::Buffers {
  std::vector<char> bytes = std::vector<char>(kMaxBatch * kDatagram);
  std::array<Datagram, kMaxBatch> datagrams{};
};

DatagramReader::DatagramReader() : buffers_(std::make_unique<Buffers>()) {}
DatagramReader::~DatagramReader() = default;

std::span<const Datagram> DatagramReader::read(int fd) {
  std::size_t got = 0;
  for (; got < kMaxBatch; got++) {
    char* const to = buffers_->bytes.data() + got * kDatagram;
    SocketAddress from;
    const ssize_t size = recvfrom(fd, to, kDatagram, MSG_DONTWAIT, from.get(), from.receive_length());
    if (size < 0) break;
    buffers_->datagrams[got] = {to, static_cast<std::size_t>(size), from.endpoint(), std::nullopt};
  }
  return std::span(buffers_->datagrams).first(got);
}

void count_dropped(int) {}

int set_receive_buffer(int fd, int bytes) {
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  int granted = 0;
  socklen_t length = sizeof granted;
  getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &length);
  return granted;
}

std::optional<long> max_receive_buffer() { return std::nullopt; }

}  // namespace limber::system
