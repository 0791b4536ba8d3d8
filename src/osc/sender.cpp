// Every send is non-blocking: what the system does not take at once is lost, counted, and said seldom.
#include "osc/sender.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/log.h"
#include "base/text.h"
#include "osc/tap.h"

namespace limber {

namespace {

constexpr int kSendBuffer = 4 << 20;  // a whole frame of a thousand bodies fits
constexpr int kUnreadBuffer = 4096;   // nobody reads what is sent to the sending socket
// what we send by ourselves
constexpr std::array<std::string_view, 13> kNeverAnswered = {"/error",
                                                             "/pong",
                                                             "/physics/joint/pos",
                                                             "/physics/joint/rot",
                                                             "/physics/joint/relrot",
                                                             "/physics/joint/relpos",
                                                             "/physics/contact",
                                                             "/transport/state",
                                                             "/script/error",
                                                             "/script/ok",
                                                             "/token",
                                                             "/subscription/reduced",
                                                             "/subscription/full"};

bool answerable(const Message& error) {
  const std::string_view about = error.args.empty() ? std::string_view() : std::string_view(error.args[0].text);
  return std::ranges::find(kNeverAnswered, about) == kNeverAnswered.end();
}

}  // namespace

Sender::Sender(Counters& counters, Traffic& traffic, std::function<int(const Endpoint&)> reply_socket,
               const NetClock& clock)
    : counters_(counters), traffic_(traffic), reply_socket_(std::move(reply_socket)), clock_(clock) {}

Result<void> Sender::open() {
  if (const Result<void> opened = out_.open(kSendBuffer, kUnreadBuffer); !opened)
    return Error{"OSC can't open a socket to send from: " + opened.error()};
  return {};
}

void Sender::send(const Outgoing& out) {
  const bool error = out.to == Outgoing::To::error;
  if (error && !answerable(out.message)) return;
  if (error && !limit_.allow({out.origin.ip, out.origin.port}, clock_.steady())) return;
  const std::span<const char> packet = encode(out.message);
  if (packet.empty()) return;
  switch (out.to) {
    case Outgoing::To::sender:
    case Outgoing::To::direct:
      to_origin(out.origin, packet, out.to == Outgoing::To::sender);
      return;
    case Outgoing::To::error:
      to_origin(out.origin, packet, true);
      to_targets(packet, true);
      return;
    case Outgoing::To::event:
      to_subscribers(packet);
      [[fallthrough]];
    case Outgoing::To::targets:
      to_targets(packet, false);
      return;
  }
}

// empty: it is too large, which is reported
std::span<const char> Sender::encode(const Message& message) {
  const std::span<const char> packet = encode_message(message, buffer_);
  if (packet.empty()) {
    if (const auto more = too_large_.ask(clock_.steady()))
      log_warning("OSC out: a message {} larger than 65504 bytes is not sent{}", printable(message.address), *more);
  }
  return packet;
}

bool Sender::send_value(const Outgoing& out) {
  const Endpoint to{out.origin.ip, out.origin.port};
  const std::span<const char> packet = encode(out.message);
  if (packet.empty()) return true;
  if (!may_serve_(to, packet.size(), 1)) return false;
  reply(to, packet);
  return true;
}

void Sender::pong(const Origin& to, std::uint64_t tick, double time) {
  to_origin(to, encode_pong(tick, time, buffer_), true);
}

void Sender::to_origin(const Origin& origin, std::span<const char> packet, bool answer) {
  // a message from the panel or the command line has no address to answer to, one by WebSocket not here
  if (origin.ip == 0 || origin.port == 0 || origin.hand == Hand::query) return;
  const Endpoint to{origin.ip, origin.port};
  if (!answer) return send_to(to, packet);
  if (may_answer_(to, packet.size(), 1)) reply(to, packet);
}

// from the socket by which its question came
void Sender::reply(const Endpoint& to, std::span<const char> packet) {
  const int listening = reply_socket_(to);
  if (listening < 0 || is_own(to)) return send_to(to, packet);
  note_result(system::send_datagram(listening, to, packet), to, packet);
}

void Sender::set_own(std::vector<Endpoint> inputs, std::vector<std::uint32_t> addresses) {
  inputs_ = std::move(inputs);
  addresses_ = std::move(addresses);
}

bool Sender::is_own(const Endpoint& end) const {
  constexpr std::uint32_t kLoopback = 127;
  return std::ranges::any_of(inputs_, [&](const Endpoint& input) {
    if (input.port != end.port) return false;
    const bool here =
        end.ip == 0 || end.ip >> 24 == kLoopback || std::ranges::find(addresses_, end.ip) != addresses_.end();
    return input.ip == end.ip || (here && (input.ip == 0 || end.ip == 0));
  });
}

void Sender::report_own(const Endpoint& end) {
  constexpr std::size_t kMost = 16;
  if (std::ranges::find(own_reported_, end) != own_reported_.end() || own_reported_.size() >= kMost) return;
  own_reported_.push_back(end);
  loops_++;
  log_warning("OSC out {}: this is the program's own input; nothing is sent there. Choose another port (reported once)",
              endpoint_text(end));
}

void Sender::note_echo(const Endpoint& end) {
  if (!limit_.note_echo(end, clock_.steady())) return;
  loops_++;
  log_warning("OSC in: {} answers /error, which would go on for ever; it gets no /error for a minute (reported once)",
              endpoint_text(end));
}

void Sender::to_targets(std::span<const char> packet, bool only_those_wanting_errors) {
  for (const Target& target : targets_) {
    if (!only_those_wanting_errors || target.wish.errors) send_to(target.at, packet);
  }
}

void Sender::to_subscribers(std::span<const char> packet) {
  for (const Endpoint& end : subscribers_) {
    const bool target_too = std::ranges::any_of(targets_, [&](const Target& t) { return t.at == end; });
    if (!target_too && may_serve_(end, packet.size(), 1)) send_to(end, packet);
  }
}

void Sender::send_to(const Endpoint& to, std::span<const char> packet) {
  if (is_own(to)) return report_own(to);
  note_result(out_.send(to, packet), to, packet);
}

void Sender::note_result(int error, const Endpoint& to, std::span<const char> packet) {
  if (error == 0) {
    counters_.sent.fetch_add(1, std::memory_order_relaxed);
    if (traffic_.watched()) note_sent(traffic_, to, packet);
    return;
  }
  counters_.unsent.fetch_add(1, std::memory_order_relaxed);
  const std::string why = std::generic_category().message(error);
  if (const auto more = failed_.ask(clock_.steady())) {
    log_warning("OSC out: can't send to {}: {}{}", endpoint_text(to), why, *more);
  }
}

}  // namespace limber
