// Sends never block: a datagram that the system does not accept immediately is dropped and counted, and a throttled
// warning is logged.
#include "net/osc/sender.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/log/log.h"
#include "base/text.h"
#include "net/osc/packets/decode.h"

namespace limber::osc {

namespace {

constexpr int kSendBuffer = 4 << 20;  // fits a frame of a thousand bodies
constexpr int kUnreadBuffer = 4096;   // the sending socket is never read
// messages that this program sends unprompted
constexpr std::array<std::string_view, 14> kNoErrorReply = {"/error",
                                                            "/pong",
                                                            "/physics/joint/pos",
                                                            "/physics/joint/rot",
                                                            "/physics/joint/relrot",
                                                            "/physics/joint/relpos",
                                                            "/physics/contact",
                                                            "/physics/contact/point",
                                                            "/transport/state",
                                                            "/script/error",
                                                            "/script/ok",
                                                            "/token",
                                                            "/subscription/reduced",
                                                            "/subscription/full"};

bool answerable(const Message& error) {
  const std::string_view about = error.args.empty() ? std::string_view() : std::string_view(error.args[0].text);
  return std::ranges::find(kNoErrorReply, about) == kNoErrorReply.end();
}

}  // namespace

Sender::Sender(engine::Counters& counters, engine::MessageLog& message_log,
               std::function<int(const Endpoint&)> reply_socket, const NetClock& clock)
    : counters_(counters), message_log_(message_log), reply_socket_(std::move(reply_socket)), clock_(clock) {}

Result<void> Sender::open() {
  if (const Result<void> opened = out_.open(kSendBuffer, kUnreadBuffer); !opened)
    return Error{"OSC can't open a socket for sending: " + opened.error()};
  return {};
}

void Sender::send(const engine::Outgoing& out) {
  const bool error = out.destination == engine::Outgoing::Destination::error;
  if (error && !answerable(out.message)) return;
  if (error && !error_limiter_.allow({out.origin.ip, out.origin.port}, clock_.steady())) return;
  const std::span<const char> packet = encode(out.message);
  if (packet.empty()) return;
  switch (out.destination) {
    case engine::Outgoing::Destination::reply:
    case engine::Outgoing::Destination::direct:
      send_to_origin(out.origin, packet, out.destination == engine::Outgoing::Destination::reply);
      return;
    case engine::Outgoing::Destination::error:
      send_to_origin(out.origin, packet, true);
      send_to_targets(packet, true);
      return;
    case engine::Outgoing::Destination::event:
      send_to_subscribers(packet);
      [[fallthrough]];
    case engine::Outgoing::Destination::targets:
      send_to_targets(packet, false);
      return;
  }
}

// Returns an empty span if the message is too large, after logging a throttled warning.
std::span<const char> Sender::encode(const Message& message) {
  const std::span<const char> packet = encode_message(message, buffer_);
  if (packet.empty()) {
    if (const auto more = too_large_log_.admit(clock_.steady()))
      log_warning("OSC out: {} not sent: the message is larger than 65504 bytes{}", printable(message.address), *more);
  }
  return packet;
}

bool Sender::send_value(const engine::Outgoing& out) {
  const Endpoint to{out.origin.ip, out.origin.port};
  const std::span<const char> packet = encode(out.message);
  if (packet.empty()) return true;
  if (!may_serve_(to, packet.size(), 1)) return false;
  reply(to, packet);
  return true;
}

void Sender::pong(const CommandOrigin& to, std::uint64_t tick, double time) {
  send_to_origin(to, encode_pong(tick, time, buffer_), true);
}

void Sender::send_to_origin(const CommandOrigin& origin, std::span<const char> packet, bool is_answer) {
  // a message from the panel or the command line has no return address; WebSocket answers take another path
  if (origin.ip.is_any() || origin.port == 0 || origin.source == CommandSource::oscquery) return;
  const Endpoint to{origin.ip, origin.port};
  if (!is_answer) return send_to(to, packet);
  if (may_answer_(to, packet.size(), 1)) reply(to, packet);
}

// Sends from the socket that received the sender's message.
void Sender::reply(const Endpoint& to, std::span<const char> packet) {
  if (send_by_tcp(to, packet)) return;
  const int listening = reply_socket_(to);
  if (listening < 0 || is_own_input(to)) return send_to(to, packet);
  handle_result(system::send_datagram(listening, to, packet), to, packet);
}

// Returns false if the receiver is not connected by TCP.
bool Sender::send_by_tcp(const Endpoint& to, std::span<const char> packet) {
  if (tcp_ == nullptr || !tcp_->is_connected(to)) return false;
  handle_result(tcp_->send(to, packet), to, packet);
  return true;
}

void Sender::set_own_inputs(std::vector<Endpoint> inputs, std::vector<IpAddress> addresses) {
  inputs_ = std::move(inputs);
  addresses_ = std::move(addresses);
}

bool Sender::is_own_input(const Endpoint& target) const {
  return std::ranges::any_of(inputs_, [&](const Endpoint& input) {
    if (input.port != target.port || input.ip.is_v6 != target.ip.is_v6) return false;
    const bool here =
        target.ip.is_any() || target.ip.is_loopback() || std::ranges::find(addresses_, target.ip) != addresses_.end();
    return input.ip == target.ip || (here && (input.ip.is_any() || target.ip.is_any()));
  });
}

void Sender::report_own_input(const Endpoint& target) {
  constexpr std::size_t kMaxReported = 16;
  if (std::ranges::find(reported_own_inputs_, target) != reported_own_inputs_.end() ||
      reported_own_inputs_.size() >= kMaxReported)
    return;
  reported_own_inputs_.push_back(target);
  loops_++;
  log_warning("OSC out {}: this is the program's own input; nothing is sent there. Choose another port (reported once)",
              endpoint_text(target));
}

void Sender::record_error_answer(const Endpoint& peer) {
  if (!error_limiter_.record_answer(peer, clock_.steady())) return;
  loops_++;
  log_warning("OSC in: {} answers /error messages, which would loop forever; it gets none for a minute (reported once)",
              endpoint_text(peer));
}

void Sender::send_to_targets(std::span<const char> packet, bool errors_only) {
  for (const ResolvedTarget& target : targets_) {
    if (!errors_only || target.config.errors) send_to(target.endpoint, packet);
  }
}

void Sender::send_to_subscribers(std::span<const char> packet) {
  for (const Endpoint& subscriber : subscribers_) {
    const bool target_too =
        std::ranges::any_of(targets_, [&](const ResolvedTarget& t) { return t.endpoint == subscriber; });
    if (!target_too && may_serve_(subscriber, packet.size(), 1)) send_to(subscriber, packet);
  }
}

void Sender::send_to(const Endpoint& to, std::span<const char> packet) {
  if (send_by_tcp(to, packet)) return;
  if (is_own_input(to)) return report_own_input(to);
  handle_result(out_.send(to, packet), to, packet);
}

void Sender::handle_result(int error, const Endpoint& to, std::span<const char> packet) {
  if (error == 0) {
    counters_.sent.fetch_add(1, std::memory_order_relaxed);
    if (message_log_.enabled()) log_sent(message_log_, to, packet);
    return;
  }
  counters_.unsent.fetch_add(1, std::memory_order_relaxed);
  const std::string reason = std::generic_category().message(error);
  if (const auto more = failed_log_.admit(clock_.steady())) {
    log_warning("OSC out: can't send to {}: {}{}", endpoint_text(to), reason, *more);
  }
}

void log_sent(engine::MessageLog& message_log, const Endpoint& to, std::span<const char> packet) {
  // stream frames exist only as bytes, so packets are decoded again
  const Result<Decoded> decoded = decode_packet(packet.data(), packet.size());
  if (!decoded) return;
  for (const Message& message : decoded->messages) message_log.add(false, endpoint_text(to), message);
}

}  // namespace limber::osc
