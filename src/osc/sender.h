// The sender: answers, errors and a scene's messages, each one datagram, from a socket that is bound to no address, so
// that one who listens on this machine only can still send to others.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/system/udp_socket.h"
#include "engine/command.h"
#include "engine/traffic.h"
#include "osc/clock.h"
#include "osc/encode.h"
#include "osc/endpoint.h"
#include "osc/error_limit.h"
#include "osc/seldom.h"

namespace limber {

/// A stream target with its address looked up.
struct Target {
  StreamTarget wish;
  Endpoint at;

  bool operator==(const Target&) const = default;
};

/// [net]
class Sender {
 public:
  /// `reply_socket` gives the listening socket of a sender's question, or -1.
  Sender(Counters& counters, Traffic& traffic, std::function<int(const Endpoint&)> reply_socket, const NetClock& clock);

  Result<void> open();
  void close() { out_.close(); }
  /// The socket, from which streams are sent too.
  system::UdpSender& socket() { return out_; }
  void set_targets(std::vector<Target> targets) { targets_ = std::move(targets); }
  /// Who gets events beside them.
  void set_subscribers(std::vector<Endpoint> ends) { subscribers_ = std::move(ends); }

  /// Sends to whom it is for. Refused messages are answered ten times a second per sender, and never when what was
  /// refused is itself an answer or a stream: two programs aimed at each other fall silent.
  void send(const Outgoing& out);
  void pong(const Origin& to, std::uint64_t tick, double time);

 private:
  void to_origin(const Origin& origin, std::span<const char> packet, bool answer);
  void to_targets(std::span<const char> packet, bool only_those_wanting_errors);
  void to_subscribers(std::span<const char> packet);
  void send_to(const Endpoint& to, std::span<const char> packet);
  void note_result(int error, const Endpoint& to, std::span<const char> packet);

  Counters& counters_;
  Traffic& traffic_;
  std::function<int(const Endpoint&)> reply_socket_;
  const NetClock& clock_;
  system::UdpSender out_;
  std::vector<Target> targets_;
  std::vector<Endpoint> subscribers_;
  ErrorLimit limit_;
  PacketBuffer buffer_;
  Seldom failed_, too_large_;
};

}  // namespace limber
