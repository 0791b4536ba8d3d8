// Sender: sends answers, errors and a scene's messages, one datagram each, or by TCP to clients that are connected. Its
// UDP socket is not bound to an address, so it reaches other machines even if the program listens on loopback only.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/system/net/udp_socket.h"
#include "engine/commands/command.h"
#include "engine/output/message_log.h"
#include "net/osc/clock.h"
#include "net/osc/endpoint.h"
#include "net/osc/error_rate_limit.h"
#include "net/osc/packets/encode.h"
#include "net/osc/tcp/tcp_peers.h"
#include "net/osc/warning_throttle.h"

namespace limber::osc {

/// A stream target with its resolved address.
struct ResolvedTarget {
  StreamTarget config;
  Endpoint endpoint;
  bool subscribed = false;  ///< True if a /subscribe created it, false if it is configured.

  bool operator==(const ResolvedTarget&) const = default;
};

/// Returns true if datagrams of `bytes` bytes in total may be sent to `to` now.
using SendGate = std::function<bool(const Endpoint& to, std::size_t bytes, std::size_t datagrams)>;

/// Sends single messages. [net]
class Sender {
 public:
  /// `reply_socket` returns the listening socket that received a sender's last message, or -1.
  Sender(engine::Counters& counters, engine::MessageLog& message_log, std::function<int(const Endpoint&)> reply_socket,
         const NetClock& clock);

  /// Sets the gates for answers and for messages to subscribers. Neither applies to configured targets.
  void set_gates(SendGate answers, SendGate subscriptions) {
    may_answer_ = std::move(answers);
    may_serve_ = std::move(subscriptions);
  }
  /// Sets the clients that receive by their connection instead of by UDP.
  void set_tcp(TcpPeers& tcp) { tcp_ = &tcp; }
  /// Sets the endpoints this program listens on and this machine's addresses, including those of
  /// broadcasts. Nothing is sent to its own inputs.
  void set_own_inputs(std::vector<Endpoint> inputs, std::vector<IpAddress> addresses);
  bool is_own_input(const Endpoint& target) const;
  /// Warns once that a target is the program's own input.
  void report_own_input(const Endpoint& target);

  /// Opens the socket. Call it before sending.
  Result<void> open();
  void close() { out_.close(); }
  /// The socket, which the streams share.
  system::UdpSender& socket() { return out_; }
  void set_targets(std::vector<ResolvedTarget> targets) { targets_ = std::move(targets); }
  /// Sets the additional receivers of events.
  void set_subscribers(std::vector<Endpoint> endpoints) { subscribers_ = std::move(endpoints); }

  /// Sends a message to the receivers that `out.destination` selects. Error messages are limited to ten a second per
  /// sender, and none is sent if the rejected message was itself an answer or a stream, so that two programs aimed at
  /// each other do not loop.
  void send(const engine::Outgoing& out);
  /// Sends a `/pong` to the sender of a `/ping`.
  void pong(const CommandOrigin& to, std::uint64_t tick, double time);
  /// Sends a subscribed value. Returns false if the subscriber's budget does not allow it now.
  bool send_value(const engine::Outgoing& out);
  /// Records that `peer` answers /error messages; it gets none for a minute.
  void record_error_answer(const Endpoint& peer);
  /// Number of message loops detected and stopped.
  std::uint64_t loops() const { return loops_; }

 private:
  void send_to_origin(const CommandOrigin& origin, std::span<const char> packet, bool is_answer);
  void send_to_targets(std::span<const char> packet, bool errors_only);
  void send_to_subscribers(std::span<const char> packet);
  void send_to(const Endpoint& to, std::span<const char> packet);
  void reply(const Endpoint& to, std::span<const char> packet);
  bool send_by_tcp(const Endpoint& to, std::span<const char> packet);
  std::span<const char> encode(const Message& message);
  void handle_result(int error, const Endpoint& to, std::span<const char> packet);

  engine::Counters& counters_;
  engine::MessageLog& message_log_;
  std::function<int(const Endpoint&)> reply_socket_;
  const NetClock& clock_;
  system::UdpSender out_;
  TcpPeers* tcp_ = nullptr;
  std::vector<ResolvedTarget> targets_;
  std::vector<Endpoint> subscribers_;
  SendGate may_answer_ = [](const Endpoint&, std::size_t, std::size_t) { return true; };
  SendGate may_serve_ = may_answer_;
  std::vector<Endpoint> inputs_;
  std::vector<IpAddress> addresses_;
  std::vector<Endpoint> reported_own_inputs_;
  std::uint64_t loops_ = 0;
  ErrorRateLimit error_limiter_;
  PacketBuffer buffer_;
  WarningThrottle failed_log_, too_large_log_;
};

/// Logs each message of a packet that this program encoded. Costs a decoding, so call it only while the log is enabled.
/// [net]
void log_sent(engine::MessageLog& message_log, const Endpoint& to, std::span<const char> packet);

}  // namespace limber::osc
