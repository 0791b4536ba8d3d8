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
  bool subscribed = false;  ///< It has asked for it; else the performer has named it.

  bool operator==(const Target&) const = default;
};

/// Whether a datagram of so many bytes may go to a sender now.
using SendGate = std::function<bool(const Endpoint& to, std::size_t bytes, std::size_t datagrams)>;

/// [net]
class Sender {
 public:
  /// `reply_socket` gives the listening socket of a sender's question, or -1.
  Sender(Counters& counters, Traffic& traffic, std::function<int(const Endpoint&)> reply_socket, const NetClock& clock);

  /// Of answers, and of what subscribers get. What the performer has named as a target passes neither.
  void set_gates(SendGate answers, SendGate subscriptions) {
    may_answer_ = std::move(answers);
    may_serve_ = std::move(subscriptions);
  }
  /// Where this program listens itself, and the addresses of this machine: nothing is sent there.
  void set_own(std::vector<Endpoint> inputs, std::vector<std::uint32_t> addresses);
  bool is_own(const Endpoint& end) const;
  /// Reports an own input as a target, once.
  void report_own(const Endpoint& end);

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
  /// A subscriber's value. False: it may not be sent now.
  bool send_value(const Outgoing& out);
  /// It has answered an /error: it gets none for a while.
  void note_echo(const Endpoint& end);
  /// Loops that were found and ended.
  std::uint64_t loops() const { return loops_; }

 private:
  void to_origin(const Origin& origin, std::span<const char> packet, bool answer);
  void to_targets(std::span<const char> packet, bool only_those_wanting_errors);
  void to_subscribers(std::span<const char> packet);
  void send_to(const Endpoint& to, std::span<const char> packet);
  void reply(const Endpoint& to, std::span<const char> packet);
  std::span<const char> encode(const Message& message);
  void note_result(int error, const Endpoint& to, std::span<const char> packet);

  Counters& counters_;
  Traffic& traffic_;
  std::function<int(const Endpoint&)> reply_socket_;
  const NetClock& clock_;
  system::UdpSender out_;
  std::vector<Target> targets_;
  std::vector<Endpoint> subscribers_;
  SendGate may_answer_ = [](const Endpoint&, std::size_t, std::size_t) { return true; };
  SendGate may_serve_ = may_answer_;
  std::vector<Endpoint> inputs_;
  std::vector<std::uint32_t> addresses_;
  std::vector<Endpoint> own_reported_;
  std::uint64_t loops_ = 0;
  ErrorLimit limit_;
  PacketBuffer buffer_;
  Seldom failed_, too_large_;
};

}  // namespace limber
