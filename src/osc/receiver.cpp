// Datagrams in rounds of sixteen; nothing here throws, and nothing is logged per datagram.
#include "osc/receiver.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "osc/decode.h"
#include "osc/packet_walk.h"
#include "osc/subscribers.h"
#include "osc/validate.h"

namespace limber {

namespace {

constexpr int kRounds = 64;
constexpr int kReceiveBuffer = 4 << 20;
constexpr std::size_t kRawCost = 256;  // of a datagram, beside its bytes
constexpr const char* kTooFast = "OSC comes in faster than the simulation takes it: messages are dropped";
constexpr const char* kCure = "choose another with --osc-in ADDR:PORT, or play without with --osc-optional";

std::size_t slot_of(const Endpoint& e) { return (e.ip * 2654435761u ^ e.port * 40503u) >> 7; }

}  // namespace

// the text is made only when it is said
template <class Text>
void Receiver::warn_seldom(Seldom& kind, const Text& text) {
  if (const std::optional<std::string> more = kind.ask(clock_.steady())) log_warning("{}{}", text(), *more);
}

struct Receiver::Listening {
  ListenAddress wish;
  system::UdpSocket socket;
  std::uint32_t kernel_drops = 0;  // the kernel counts from the socket's birth
};

Receiver::Receiver(EngineLink& link, std::vector<Cidr> allow, ReceiverAnswers answers, const NetClock& clock)
    : link_(link), allow_(std::move(allow)), answers_(std::move(answers)), clock_(clock), held_(clock) {}

Receiver::~Receiver() = default;

void Receiver::close() { sockets_.clear(); }

std::vector<std::string> Receiver::listen(const std::vector<ListenAddress>& addresses) {
  std::erase_if(sockets_, [&](const auto& s) { return std::ranges::find(addresses, s->wish) == addresses.end(); });
  std::vector<std::string> faults;
  for (const ListenAddress& address : addresses) {
    const bool open_already = std::ranges::any_of(sockets_, [&](const auto& s) { return s->wish == address; });
    if (open_already) continue;
    if (std::optional<std::string> fault = open(address)) faults.push_back(*fault);
  }
  return faults;
}

bool Receiver::wants_more(const std::vector<ListenAddress>& addresses) const {
  const bool numbers = std::ranges::all_of(addresses, [](const auto& a) { return parse_ipv4(a.address).has_value(); });
  return numbers && std::ranges::any_of(addresses, [this](const ListenAddress& address) {
           return std::ranges::none_of(sockets_, [&](const auto& s) { return s->wish == address; });
         });
}

std::optional<std::string> Receiver::open(const ListenAddress& address) {
  const std::string name = fmt::format("{}:{}", printable(address.address), address.port);
  const Result<Endpoint> at = resolve(address.address, address.port);
  if (!at) return fmt::format("OSC can't listen on {}: {}; {}", name, at.error(), kCure);
  Result<system::UdpSocket> socket = system::open_udp(*at);
  if (!socket) return fmt::format("OSC can't listen on {}: {}; {}", name, socket.error(), kCure);

  system::count_dropped(socket->fd());
  const int granted = system::set_receive_buffer(socket->fd(), kReceiveBuffer);
  if (granted < kReceiveBuffer && !said_buffer_) {
    said_buffer_ = true;
    log_info(
        "OSC in: the system grants a receive buffer of {} KiB instead of {}; bursts of many messages may lose "
        "some; cure: sysctl -w net.core.rmem_max={}",
        granted / 1024, kReceiveBuffer / 1024, kReceiveBuffer);
  }
  if (at->ip == 0) {
    log_warning("OSC in {}: open to the network{}", name,
                allow_.empty() ? ", everyone may play; --osc-allow CIDR limits it" : " for whom --osc-allow names");
  }
  sockets_.push_back(std::make_unique<Listening>(Listening{address, std::move(*socket), 0}));
  return std::nullopt;
}

std::vector<int> Receiver::descriptors() const {
  std::vector<int> list;
  for (const auto& s : sockets_) list.push_back(s->socket.fd());
  return list;
}

std::vector<Endpoint> Receiver::bound() const {
  std::vector<Endpoint> list;
  for (const auto& s : sockets_) list.push_back(s->socket.local());
  return list;
}

void Receiver::receive(int fd) {
  const auto found = std::ranges::find_if(sockets_, [&](const auto& s) { return s->socket.fd() == fd; });
  if (found == sockets_.end()) return;
  Listening& socket = **found;
  for (int round = 0; round < kRounds; round++) {
    const std::span<const system::Datagram> datagrams = reader_.read(fd);
    for (const system::Datagram& datagram : datagrams) {
      if (datagram.dropped) note_kernel_drops(socket, *datagram.dropped);
      take_from(socket, datagram.data, datagram.size, datagram.from);
    }
    // an error (nothing there, a signal) is the same as an empty round: the wait says when there is more
    if (datagrams.size() < system::DatagramReader::kMost) break;
  }
}

void Receiver::take_from(Listening& socket, const char* data, std::size_t size, const Endpoint& from) {
  known_[slot_of(from) % kKnown] = {from, socket.socket.fd()};
  answers_.received(from, size);
  const Scanned scanned = scan(data, size, {Hand::osc, from.ip, from.port});
  pushed_ = pushed_ || scanned.urgent;
  if (raw_.size() < kMostRaw && raw_bytes_ + size <= kMostRawBytes) {
    raw_.push_back({{data, size}, from, scanned});
    raw_bytes_ += size;
    return;
  }
  link_.counters.dropped.fetch_add(1, std::memory_order_relaxed);
  warn_seldom(inbox_full_, [] { return kTooFast; });
}

namespace {

// whether a valid packet has an urgent address
struct UrgentAddresses {
  bool any = false;
  static void bundle(int, std::uint64_t) {}
  void message(const char* address, const char*) { any = any || urgent_address(address).has_value(); }
  static void argument(char, const char*) {}
  static void end_message() {}
};

// an /error, or a message about one
bool answers_error(const Message& message) {
  constexpr std::string_view kError = "/error";
  return same_address(message.address, kError) || std::ranges::any_of(message.args, [&](const Arg& arg) {
           return arg.is_text() && arg.text.starts_with('/') && same_address(arg.text, kError);
         });
}

}  // namespace

Receiver::Scanned Receiver::scan(const char* data, std::size_t size, const Origin& origin) const {
  Scanned scanned{link_.inbox.arrive(), false};
  UrgentAddresses addresses;
  if (!allowed(origin.ip) || PacketWalk<UrgentAddresses>(addresses).packet(data, size) != nullptr || !addresses.any)
    return scanned;
  Result<Decoded> decoded = decode_packet(data, size);
  if (!decoded || held_.waits(decoded->time_tag)) return scanned;
  scanned.urgent = true;
  for (Message& message : decoded->messages) {
    if (const std::optional<UrgentKind> kind = urgent_kind(message))
      link_.inbox.push_urgent({*kind, std::move(message), origin, scanned.arrival});
  }
  return scanned;
}

void Receiver::decode_some() {
  for (std::size_t bytes = 0; !raw_.empty() && bytes < kDecodedBytes;) {
    const Raw raw = std::move(raw_.front());
    raw_.pop_front();
    raw_bytes_ -= raw.bytes.size();
    bytes += raw.bytes.size() + kRawCost;
    take(raw.bytes.data(), raw.bytes.size(), {Hand::osc, raw.from.ip, raw.from.port}, raw.scanned);
  }
}

void Receiver::take(const char* data, std::size_t size, Origin origin, Scanned scanned) {
  const Endpoint from{origin.ip, origin.port};
  if (!allowed(from.ip)) {
    link_.counters.denied.fetch_add(1, std::memory_order_relaxed);
    warn_seldom(not_allowed_,
                [&] { return fmt::format("OSC from {} ignored: --osc-allow does not hold it", endpoint_text(from)); });
    return;
  }
  const char* fault = packet_fault(data, size);
  Result<Decoded> decoded = fault == nullptr ? decode_packet(data, size) : Result<Decoded>(Error{fault});
  if (!decoded) {
    link_.counters.malformed.fetch_add(1, std::memory_order_relaxed);
    warn_seldom(malformed_, [&] {
      return fmt::format("{} bytes from {} are no OSC: {}", size, endpoint_text(from), decoded.error());
    });
    return;
  }
  link_.counters.received.fetch_add(decoded->messages.size() + decoded->refused.size(), std::memory_order_relaxed);
  if (link_.traffic.watched()) note_traffic(origin, *decoded);
  for (const RefusedMessage& r : decoded->refused) refuse(origin, r.address, r.text);

  // a ping asks this thread, not the simulation
  const auto pings = std::erase_if(decoded->messages, [](const Message& m) { return m.address == "/ping"; });
  for (std::size_t i = 0; i < pings; i++) answers_.pong(origin);
  std::erase_if(decoded->messages, [&](const Message& m) {
    if (m.address == "/token") {
      answers_.token(m, origin);
      return true;
    }
    if (answers_error(m)) answers_.echo(origin);
    if (!Subscribers::is_one(m)) return false;
    if (const Result<void> done = answers_.subscribe(m, origin); !done) refuse(origin, m.address, done.error());
    return true;
  });
  origin.follows = origin.follows || answers_.follows(origin);
  if (!decoded->messages.empty())
    deliver(decoded->time_tag, {std::move(decoded->messages), origin, nullptr, scanned.arrival}, scanned.urgent);
}

void Receiver::note_traffic(const Origin& origin, const Decoded& packet) {
  const std::string end = endpoint_text({origin.ip, origin.port}) + (origin.hand == Hand::query ? " (WebSocket)" : "");
  for (const Message& message : packet.messages) link_.traffic.note(true, end, message);
  for (const RefusedMessage& refused : packet.refused) link_.traffic.note(true, end, {refused.address, {}});
}

// what was found due by scan() is due, whatever the clock says now
void Receiver::deliver(std::uint64_t time_tag, Command command, bool urgent_pushed) {
  switch (urgent_pushed ? HeldCommands::Verdict::now : held_.offer(time_tag, command)) {
    case HeldCommands::Verdict::held:
      return;
    case HeldCommands::Verdict::far:
      warn_seldom(far_, [&] {
        return fmt::format(
            "a bundle from {} is dated more than 10 s ahead: applied now; its sender's clock or this "
            "machine's is wrong",
            endpoint_text({command.origin.ip, command.origin.port}));
      });
      break;
    case HeldCommands::Verdict::full:
      warn_seldom(held_full_, [] {
        return fmt::format("{} bundles or {} MiB wait for their time: further ones are applied now",
                           HeldCommands::kMost, HeldCommands::kMostBytes >> 20);
      });
      break;
    case HeldCommands::Verdict::now:
      break;
  }
  push(std::move(command), urgent_pushed);
}

void Receiver::release_due() {
  decode_some();
  while (std::optional<Command> command = held_.due()) {
    command->arrival = 0;  // it arrives now
    push(std::move(*command));
  }
  if (std::exchange(pushed_, false)) link_.wake_engine();
}

void Receiver::push(Command command, bool urgent_pushed) {
  const std::size_t count = command.messages.size();
  if (link_.inbox.push(std::move(command), urgent_pushed)) {
    pushed_ = true;
    return;
  }
  link_.counters.dropped.fetch_add(count, std::memory_order_relaxed);
  warn_seldom(inbox_full_, [] { return kTooFast; });
}

void Receiver::refuse(const Origin& origin, const std::string& address, const std::string& text) {
  link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  answers_.error({Outgoing::To::error, origin, error_message(address, text)});
}

void Receiver::note_kernel_drops(Listening& socket, std::uint32_t count) {
  // unsigned: right even when the kernel's counter wraps
  const std::uint32_t news = count - socket.kernel_drops;
  socket.kernel_drops = count;
  if (news == 0) return;
  link_.counters.dropped_kernel.fetch_add(news, std::memory_order_relaxed);
  warn_seldom(kernel_full_, [&] {
    return fmt::format(
        "OSC in {}: the system dropped {} datagrams; a larger net.core.rmem_max or bundles instead of "
        "single messages help",
        endpoint_text(socket.socket.local()), news);
  });
}

int Receiver::socket_of(const Endpoint& sender) const {
  const Known& known = known_[slot_of(sender) % kKnown];
  if (known.sender != sender) return -1;
  // the socket may have been closed since, and its number given to something else
  const bool ours = std::ranges::any_of(sockets_, [&](const auto& s) { return s->socket.fd() == known.fd; });
  return ours ? known.fd : -1;
}

bool Receiver::allowed(std::uint32_t ip) const { return holds(allow_, ip); }

}  // namespace limber
