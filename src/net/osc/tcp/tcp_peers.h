// TcpPeers: OSC clients that are connected by TCP. Each has the framing of its first byte, and gets its answers,
// subscriptions and streams by its connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/osc_config.h"
#include "base/system/descriptor.h"
#include "base/system/wait.h"
#include "net/osc/clock.h"
#include "net/osc/endpoint.h"
#include "net/osc/tcp/framing.h"
#include "net/osc/warning_throttle.h"

namespace limber::osc {

struct TcpCallbacks {
  std::function<bool(const IpAddress& ip)> is_allowed;
  /// Called for each packet.
  std::function<void(const Endpoint& from, std::string_view packet)> receive;
  /// Called after a connection has ended.
  std::function<void(const Endpoint& peer)> closed;
};

/// [net]
class TcpPeers {
 public:
  static constexpr std::size_t kMaxConnections = 64;
  /// Maximum number of bytes that a client has not read; further packets to it are dropped.
  static constexpr std::size_t kMaxUnsent = std::size_t{4} << 20;

  TcpPeers(TcpCallbacks callbacks, const NetClock& clock) : callbacks_(std::move(callbacks)), clock_(clock) {}

  /// Opens the addresses that are not open. Returns an error text for each that can't be opened; they are tried again
  /// every second by work().
  std::vector<std::string> listen(const std::vector<ListenAddress>& addresses);
  void close();
  std::vector<Endpoint> bound() const;

  /// Appends the descriptors to wait for.
  void add_poll_entries(std::vector<system::PollEntry>& list) const;
  /// Nanoseconds until work() has something to do without an event; empty: nothing.
  std::optional<std::int64_t> timeout() const;
  /// Accepts connections, reads from each at most 64 KiB, and writes. Returns true if an address was opened.
  bool work();

  bool is_connected(const Endpoint& peer) const { return find(peer) != nullptr; }
  /// Sends a packet to a connected client. Returns 0, or an errno if the packet was dropped.
  int send(const Endpoint& to, std::span<const char> packet);

 private:
  struct Listener {
    ListenAddress address;
    system::Descriptor socket;
  };
  struct Connection {
    system::Descriptor socket;
    Endpoint peer;
    PacketSplitter input;
    std::string output;
    bool ended = false;
  };

  Connection* find(const Endpoint& peer) const;
  void accept_connections(const system::Descriptor& listener);
  void read(Connection& connection);
  static void write(Connection& connection);

  TcpCallbacks callbacks_;
  const NetClock& clock_;
  std::vector<ListenAddress> addresses_;
  std::vector<Listener> listeners_;
  std::vector<std::unique_ptr<Connection>> connections_;
  std::optional<std::int64_t> retry_at_;      // ns; next attempt to open the missing addresses
  std::optional<std::int64_t> accept_again_;  // ns; accepting failed for lack of descriptors or memory
  WarningThrottle denied_log_, full_log_, malformed_log_;
};

}  // namespace limber::osc
