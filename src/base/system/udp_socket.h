// UDP: sockets, datagrams in batches, and datagrams that came back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "base/system/socket.h"

namespace limber::system {

class UdpSocket : public Descriptor {
 public:
  using Descriptor::Descriptor;
  explicit UdpSocket(Descriptor opened) : Descriptor(std::move(opened)) {}
  /// The local end: the port that the system chose, where it was asked to.
  Endpoint local() const;
};

/// A non-blocking UDP socket bound to `at` (port 0: the system chooses). The error says why not, nothing more.
Result<UdpSocket> open_udp(const Endpoint& at);

/// Requests a receive buffer of this size; returns the size that the system grants, in bytes.
int set_receive_buffer(int fd, int bytes);
void set_send_buffer(int fd, int bytes);
void allow_broadcast(int fd);
/// The largest receive buffer that the system grants; nothing: it does not tell.
std::optional<long> max_receive_buffer();

/// A datagram that was received.
struct Datagram {
  const char* data = nullptr;  ///< Until the next read().
  std::size_t size = 0;
  Endpoint from;
  /// Datagrams that the system has dropped at this socket since it was opened, modulo 2^32; nothing: none, or it does
  /// not count them.
  std::optional<std::uint32_t> dropped;
};

/// Reads datagrams, many with one system call where there is one. [one thread]
class DatagramReader {
 public:
  static constexpr std::size_t kMost = 16;

  DatagramReader();
  ~DatagramReader();
  DatagramReader(const DatagramReader&) = delete;
  DatagramReader& operator=(const DatagramReader&) = delete;

  /// Up to kMost that wait at the socket; none is also the result of an error. Never waits.
  std::span<const Datagram> read(int fd);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};
/// Makes the system count the datagrams that it drops at a socket, where it can.
void count_dropped(int fd);

/// Sends one datagram without waiting; 0, or the error's number.
int send_datagram(int fd, const Endpoint& to, std::span<const char> packet);

/// Result of a batch.
struct BatchResult {
  std::size_t sent = 0;  ///< Datagrams.
  int error = 0;         ///< errno of the first that was not sent; the rest was not tried. 0: all were sent.
};

/// A datagram that did not reach its target.
struct SendFailure {
  Endpoint to;
  int error = 0;
};

/// A socket to send from, or some of them, bound to no address. Where the system reports datagrams that came back, they
/// are returned by next_failure(). [one thread]
class UdpSender {
 public:
  UdpSender();
  ~UdpSender();
  UdpSender(UdpSender&&) noexcept;
  UdpSender& operator=(UdpSender&&) noexcept;

  /// `send_buffer` and `receive_buffer` are bytes; 0: as the system has them.
  Result<void> open(int send_buffer = 0, int receive_buffer = 0);
  void close();
  bool is_open() const { return state_ != nullptr; }

  /// Sends one datagram; 0, or the error's number. An error about an earlier datagram is none.
  int send(const Endpoint& to, std::span<const char> packet);
  /// Sends datagrams of these sizes, which follow each other in `bytes`. Runs of equal size are one piece that the
  /// system cuts (UDP segmentation) as long as `segmentation` is true; it becomes false where the route can't.
  BatchResult send(const Endpoint& to, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                   bool& segmentation);
  /// The next datagram that came back since the last call.
  std::optional<SendFailure> next_failure();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether an error of a send reports an earlier datagram, perhaps to another target: a second try sends.
bool reports_earlier(int error);

}  // namespace limber::system
