// UDP sockets, batched receive and send, and reports of undelivered datagrams.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "base/system/net/socket.h"

namespace limber::system {

class UdpSocket : public Descriptor {
 public:
  using Descriptor::Descriptor;
  explicit UdpSocket(Descriptor opened) : Descriptor(std::move(opened)) {}
  /// Returns the local endpoint, with the port that the system chose if 0 was requested.
  Endpoint local() const;
};

/// Whether other programs may open the same port. They all receive broadcast and multicast datagrams; others reach one
/// of the programs only.
enum class PortSharing : std::uint8_t { exclusive, shared };

/// Opens a non-blocking UDP socket bound to `at` (port 0: the system chooses). One of IPv6 receives no IPv4. The error
/// is the system's message.
Result<UdpSocket> open_udp(const Endpoint& at, PortSharing sharing = PortSharing::exclusive);

/// Opens a non-blocking UDP socket that receives the datagrams for a multicast group. IPv4: on each interface with one
/// of these addresses; IPv6: on the interface of the group's zone, or on all. Other programs may receive them, too. The
/// error is the system's message.
Result<UdpSocket> open_multicast(const Endpoint& group, std::span<const IpAddress> interfaces);

/// Requests a receive buffer of this size; returns the size that the system grants, in bytes.
int set_receive_buffer(int fd, int bytes);
void set_send_buffer(int fd, int bytes);
void allow_broadcast(int fd);
/// Sends multicast datagrams from the interface with this address (0: the system chooses), over up to 8 routers.
void send_multicast_from(int fd, std::uint32_t ip);
/// Returns the largest receive buffer that the system grants, in bytes; nullopt if unknown.
std::optional<long> max_receive_buffer();

/// A received datagram.
struct Datagram {
  const char* data = nullptr;  ///< Valid until the next read().
  std::size_t size = 0;
  Endpoint from;
  /// Number of datagrams that the system dropped at this socket since it was opened, modulo 2^32; nullopt: none, or the
  /// system does not count them.
  std::optional<std::uint32_t> dropped;
};

/// Reads datagrams, in batches if the system has a call for it. [one thread]
class DatagramReader {
 public:
  static constexpr std::size_t kMaxBatch = 16;

  DatagramReader();
  ~DatagramReader();
  DatagramReader(const DatagramReader&) = delete;
  DatagramReader& operator=(const DatagramReader&) = delete;

  /// Returns up to kMaxBatch pending datagrams; none on error. Never blocks.
  std::span<const Datagram> read(int fd);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};
/// Makes the system count the datagrams that it drops at a socket, if it can.
void count_dropped(int fd);

/// Sends one datagram without blocking. Returns 0 or an errno.
int send_datagram(int fd, const Endpoint& to, std::span<const char> packet);

/// Result of a batch.
struct BatchResult {
  std::size_t sent = 0;  ///< Number of datagrams.
  int error = 0;         ///< errno of the first unsent datagram, after which sending stopped. 0: all were sent.
};

/// A report that a datagram did not reach its target.
struct SendFailure {
  Endpoint to;
  int error = 0;
};

/// Sends datagrams from one or several unbound sockets. If the system reports undelivered datagrams (ICMP errors),
/// next_failure() returns them. [one thread]
class UdpSender {
 public:
  UdpSender();
  ~UdpSender();
  UdpSender(UdpSender&&) noexcept;
  UdpSender& operator=(UdpSender&&) noexcept;

  /// `send_buffer` and `receive_buffer` in bytes; 0: the system's default.
  Result<void> open(int send_buffer = 0, int receive_buffer = 0);
  void close();
  bool is_open() const { return state_ != nullptr; }

  /// Sends one datagram. Returns 0 or an errno. Ignores errors about earlier datagrams.
  int send(const Endpoint& to, std::span<const char> packet);
  /// Sends datagrams of these sizes, which are concatenated in `bytes`. While `segmentation` is true, runs of equal
  /// size are sent in one piece that the kernel splits (UDP segmentation offload); set to false if the route can't do
  /// this.
  BatchResult send(const Endpoint& to, std::span<const char> bytes, std::span<const std::uint32_t> sizes,
                   bool& segmentation);
  /// Returns the next report of an undelivered datagram.
  std::optional<SendFailure> next_failure();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// True if this error of a send may refer to an earlier datagram, perhaps to another target. Retrying sends.
bool may_report_earlier_datagram(int error);

}  // namespace limber::system
