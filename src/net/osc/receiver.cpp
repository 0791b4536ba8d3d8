// Reads datagrams in batches of sixteen. Nothing here throws, and nothing is logged per datagram.
#include "net/osc/receiver.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/plural.h"
#include "base/system/net/interfaces.h"
#include "base/text.h"
#include "net/osc/packets/decode.h"
#include "net/osc/packets/packet_parser.h"
#include "net/osc/packets/validate.h"
#include "net/osc/subscribers.h"

namespace limber::osc {

namespace {

constexpr int kMaxBatches = 64;
constexpr int kReceiveBuffer = 4 << 20;
constexpr std::int64_t kListenRetryInterval = 1'000'000'000;  // ns between two attempts to open a port
constexpr std::size_t kDatagramOverhead = 256;                // budget per datagram in addition to its bytes
constexpr const char* kQueueFullText = "OSC in: messages arrive faster than they are processed; some are dropped";
constexpr const char* kListenHint =
    "Choose another port with --osc-in ADDR:PORT, or continue without it with --osc-optional";
constexpr const char* kTrackerHint = "Motion capture from there is missing; it is tried again each second";

std::vector<IpAddress> own_addresses() {
  std::vector<IpAddress> list;
  for (const system::Subnet& subnet : system::connected_subnets()) list.push_back(subnet.ip);
  return list;
}

std::size_t slot_of(const Endpoint& e) {
  const std::uint64_t ip = e.ip.low ^ e.ip.high * 0x9e3779b97f4a7c15U;
  return static_cast<std::size_t>((ip * 2654435761U ^ std::uint64_t{e.port} * 40503U) >> 7U);
}

}  // namespace

// `text` is called only if the warning is logged.
template <class Text>
void Receiver::warn_throttled(WarningThrottle& throttle, const Text& text) {
  if (const std::optional<std::string> more = throttle.admit(clock_.steady())) log_warning("{}{}", text(), *more);
}

struct Receiver::ListenSocket {
  ListenAddress address;
  system::UdpSocket socket;
  std::uint32_t kernel_drops = 0;  // the kernel's counter, which starts with the socket
};

Receiver::Receiver(engine::EngineLink& link, std::vector<Cidr> allow, ReceiverCallbacks callbacks,
                   const NetClock& clock)
    : link_(link), allow_(std::move(allow)), callbacks_(std::move(callbacks)), clock_(clock), scheduled_(clock) {}

Receiver::~Receiver() = default;

void Receiver::close() { sockets_.clear(); }

std::vector<std::string> Receiver::listen(const std::vector<ListenAddress>& addresses) {
  std::erase_if(sockets_, [&](const auto& s) { return std::ranges::find(addresses, s->address) == addresses.end(); });
  std::vector<std::string> errors;
  for (const ListenAddress& address : addresses) {
    const bool open_already = std::ranges::any_of(sockets_, [&](const auto& s) { return s->address == address; });
    if (open_already) continue;
    const std::optional<std::string> error = open(address);
    const bool reported = std::erase(unopened_, address) > 0;
    if (!error) continue;
    if (!address.optional) errors.push_back(*error);
    if (address.optional && !reported) log_warning("{}", *error);
    if (address.optional) unopened_.push_back(address);
  }
  retry_at_.reset();
  if (can_retry(addresses)) retry_at_ = clock_.steady() + kListenRetryInterval;
  return errors;
}

// Ports may be in use, or have an address that does not exist yet. Their errors were already reported.
bool Receiver::retry_listen(const std::vector<ListenAddress>& addresses) {
  if (!retry_at_ || clock_.steady() < *retry_at_) return false;
  const std::size_t before = sockets_.size();
  (void)listen(addresses);
  return sockets_.size() != before;
}

std::optional<std::int64_t> Receiver::timeout() const {
  if (!queue_.empty()) return 0;
  std::optional<std::int64_t> timeout = scheduled_.timeout();
  if (retry_at_) {
    const std::int64_t retry = std::max<std::int64_t>(0, *retry_at_ - clock_.steady());
    timeout = std::min(timeout.value_or(retry), retry);
  }
  return timeout;
}

// True if an address is not open and opening it can be retried. Not if an address is a host name, because a look-up may
// block for seconds.
bool Receiver::can_retry(const std::vector<ListenAddress>& addresses) const {
  const bool numbers = std::ranges::all_of(addresses, [](const auto& a) { return system::is_ip_address(a.address); });
  return numbers && std::ranges::any_of(addresses, [this](const ListenAddress& address) {
           return std::ranges::none_of(sockets_, [&](const auto& s) { return s->address == address; });
         });
}

std::optional<std::string> Receiver::open(const ListenAddress& address) {
  const std::string name = host_port_text(printable(address.address), address.port);
  const Result<Endpoint> at = resolve(address.address, address.port);
  const char* const hint = address.optional ? kTrackerHint : kListenHint;
  if (!at) return fmt::format("OSC can't listen on {}: {}. {}", name, at.error(), hint);
  Result<system::UdpSocket> socket =
      at->ip.is_multicast()
          ? system::open_multicast(*at, own_addresses())
          : system::open_udp(*at, address.shared ? system::PortSharing::shared : system::PortSharing::exclusive);
  if (!socket) return fmt::format("OSC can't listen on {}: {}. {}", name, socket.error(), hint);

  system::count_dropped(socket->fd());
  const int granted = system::set_receive_buffer(socket->fd(), kReceiveBuffer);
  if (granted < kReceiveBuffer && !reported_buffer_) {
    reported_buffer_ = true;
    log_info(
        "OSC in: the system limits the receive buffer to {} KiB instead of {} KiB, so bursts may lose messages. "
        "Increase it with sysctl -w net.core.rmem_max={}",
        granted / 1024, kReceiveBuffer / 1024, kReceiveBuffer);
  }
  if (at->ip.is_any() || at->ip.is_multicast()) {
    log_warning("OSC in {}: open to the network{}", name,
                allow_.empty() ? ", every sender is accepted. Restrict it with --osc-allow CIDR"
                               : ", senders in --osc-allow are accepted");
  }
  sockets_.push_back(std::make_unique<ListenSocket>(ListenSocket{address, std::move(*socket), 0}));
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
  ListenSocket& socket = **found;
  for (int round = 0; round < kMaxBatches; round++) {
    const std::span<const system::Datagram> datagrams = reader_.read(fd);
    for (const system::Datagram& datagram : datagrams) {
      if (datagram.dropped) record_kernel_drops(socket, *datagram.dropped);
      enqueue(socket, datagram.data, datagram.size, datagram.from);
    }
    // an error (no data, a signal) is handled like an empty batch: poll reports further data
    if (datagrams.size() < system::DatagramReader::kMaxBatch) break;
  }
}

void Receiver::enqueue(ListenSocket& socket, const char* data, std::size_t size, const Endpoint& from) {
  known_senders_[slot_of(from) % kKnownSlots] = {from, socket.socket.fd()};
  callbacks_.received(from, size);
  const ScanResult scanned = scan(data, size, {CommandSource::osc, from.ip, from.port});
  wake_pending_ = wake_pending_ || scanned.urgent;
  if (queue_.size() < kMaxQueued && queued_bytes_ + size <= kMaxQueuedBytes) {
    queue_.push_back({{data, size}, from, scanned});
    queued_bytes_ += size;
    return;
  }
  link_.counters.dropped.fetch_add(1, std::memory_order_relaxed);
  warn_throttled(queue_full_log_, [] { return kQueueFullText; });
}

namespace {

// Visitor that detects urgent addresses in a valid packet.
struct UrgentAddresses {
  bool any = false;
  static void bundle(int, std::uint64_t) {}
  void message(const char* address, const char*) { any = any || engine::urgent_kind_of_address(address).has_value(); }
  static void argument(char, const char*) {}
  static void end_message() {}
};

// True for an /error message or a message with /error as an argument.
bool answers_error(const Message& message) {
  constexpr std::string_view kError = "/error";
  return same_address(message.address, kError) || std::ranges::any_of(message.args, [&](const Arg& arg) {
           return arg.is_text() && arg.text.starts_with('/') && same_address(arg.text, kError);
         });
}

bool is_for_network(const Message& message) {
  return message.address == "/ping" || message.address == "/token" || Subscribers::handles(message);
}

// Moves the messages of nested bundles that are due later out of a packet: a command for each entry of `later`.
std::vector<engine::Command> extract_later(Decoded& packet) {
  if (packet.later.empty()) return {};
  std::vector<engine::Command> commands(packet.later.size());
  std::vector<Message> now;
  std::size_t part = 0;
  for (std::size_t i = 0; i < packet.messages.size(); i++) {
    while (part < packet.later.size() && i >= packet.later[part].first + packet.later[part].count) part++;
    const bool later = part < packet.later.size() && i >= packet.later[part].first;
    const bool waits = later && !is_for_network(packet.messages[i]);
    (waits ? commands[part].messages : now).push_back(std::move(packet.messages[i]));
  }
  packet.messages = std::move(now);
  return commands;
}

}  // namespace

Receiver::ScanResult Receiver::scan(const char* data, std::size_t size, const CommandOrigin& origin) const {
  ScanResult scanned{link_.command_queue.next_arrival(), false};
  UrgentAddresses addresses;
  if (!allowed(origin.ip) || PacketParser<UrgentAddresses>(addresses).packet(data, size) != nullptr || !addresses.any)
    return scanned;
  Result<Decoded> decoded = decode_packet(data, size);
  if (!decoded || scheduled_.is_future(decoded->time_tag)) return scanned;
  scanned.urgent = true;
  (void)extract_later(*decoded);
  for (Message& message : decoded->messages) {
    if (const std::optional<engine::UrgentKind> kind = engine::urgent_kind(message))
      link_.command_queue.push_urgent({*kind, std::move(message), origin, scanned.arrival});
  }
  return scanned;
}

void Receiver::decode_slice() {
  for (std::size_t bytes = 0; !queue_.empty() && bytes < kDecodeSliceBytes;) {
    const QueuedDatagram raw = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= raw.bytes.size();
    bytes += raw.bytes.size() + kDatagramOverhead;
    process(raw.bytes.data(), raw.bytes.size(), {CommandSource::osc, raw.from.ip, raw.from.port}, raw.scanned);
  }
}

void Receiver::process(const char* data, std::size_t size, CommandOrigin origin, ScanResult scanned) {
  const Endpoint from{origin.ip, origin.port};
  if (!allowed(from.ip)) {
    link_.counters.denied.fetch_add(1, std::memory_order_relaxed);
    warn_throttled(denied_log_, [&] {
      return fmt::format("OSC from {} ignored: its address is not in --osc-allow", endpoint_text(from));
    });
    return;
  }
  if (is_psn({data, size})) return process_psn({data, size}, origin, scanned);
  const char* error = packet_fault(data, size);
  Result<Decoded> decoded = error == nullptr ? decode_packet(data, size) : Result<Decoded>(Error{error});
  if (!decoded) {
    link_.counters.malformed.fetch_add(1, std::memory_order_relaxed);
    warn_throttled(malformed_log_, [&] {
      return fmt::format("OSC in: {} from {} {} not valid OSC: {}", counted(size, "byte"), endpoint_text(from),
                         plural(size, "is", "are"), decoded.error());
    });
    return;
  }
  link_.counters.received.fetch_add(decoded->messages.size() + decoded->rejected.size(), std::memory_order_relaxed);
  if (link_.message_log.enabled()) log_messages(origin, *decoded);
  for (const RejectedMessage& r : decoded->rejected) reject(origin, r.address, r.reason);

  std::vector<engine::Command> later = extract_later(*decoded);
  // a ping is answered by this thread, not by the simulation
  const auto pings = std::erase_if(decoded->messages, [](const Message& m) { return m.address == "/ping"; });
  for (std::size_t i = 0; i < pings; i++) callbacks_.pong(origin);
  std::erase_if(decoded->messages, [&](const Message& m) {
    if (m.address == "/token") {
      callbacks_.token(m, origin);
      return true;
    }
    if (answers_error(m)) callbacks_.error_answered(origin);
    if (!Subscribers::handles(m)) return false;
    if (const Result<void> done = callbacks_.subscribe(m, origin); !done) reject(origin, m.address, done.error());
    return true;
  });
  origin.is_subscriber = origin.is_subscriber || callbacks_.is_subscriber(origin);
  if (!decoded->messages.empty())
    deliver(decoded->time_tag, {std::move(decoded->messages), origin, nullptr, scanned.arrival}, scanned.urgent);
  deliver_later(*decoded, std::move(later), origin);
}

void Receiver::deliver_later(const Decoded& packet, std::vector<engine::Command> commands,
                             const CommandOrigin& origin) {
  for (std::size_t i = 0; i < commands.size(); i++) {
    commands[i].origin = origin;
    if (!commands[i].messages.empty()) deliver(packet.later[i].time_tag, std::move(commands[i]), false);
  }
}

void Receiver::process_psn(std::string_view bytes, const CommandOrigin& origin, ScanResult scanned) {
  Result<std::vector<Message>> messages = psn_.translate(bytes, origin.ip, clock_.steady());
  if (!messages) {
    link_.counters.malformed.fetch_add(1, std::memory_order_relaxed);
    warn_throttled(malformed_log_, [&] {
      return fmt::format("a packet of PosiStageNet from {} is ignored: {}", endpoint_text({origin.ip, origin.port}),
                         messages.error());
    });
    return;
  }
  if (messages->empty()) return;
  link_.counters.received.fetch_add(messages->size(), std::memory_order_relaxed);
  Decoded packet{std::move(*messages), {}};
  if (link_.message_log.enabled()) log_messages(origin, packet);
  push({std::move(packet.messages), origin, nullptr, scanned.arrival});
}

void Receiver::log_messages(const CommandOrigin& origin, const Decoded& packet) {
  const std::string peer =
      endpoint_text({origin.ip, origin.port}) + (origin.source == CommandSource::oscquery ? " (WebSocket)" : "");
  for (const Message& message : packet.messages) link_.message_log.add(true, peer, message);
  for (const RejectedMessage& rejected : packet.rejected) link_.message_log.add(true, peer, {rejected.address, {}});
}

// A packet that scan() found to be due is applied now, even if the clock has changed since.
void Receiver::deliver(std::uint64_t time_tag, engine::Command command, bool urgent_pushed) {
  switch (urgent_pushed ? ScheduledCommands::ScheduleResult::now : scheduled_.schedule(time_tag, command)) {
    case ScheduledCommands::ScheduleResult::scheduled:
      return;
    case ScheduledCommands::ScheduleResult::too_far:
      warn_throttled(far_future_log_, [&] {
        return fmt::format(
            "OSC in: the time tag of a bundle from {} is more than 10 s ahead; applied now. Check the clocks of the "
            "sender and of this machine",
            endpoint_text({command.origin.ip, command.origin.port}));
      });
      break;
    case ScheduledCommands::ScheduleResult::full:
      warn_throttled(schedule_full_log_, [] {
        return fmt::format("OSC in: {} bundles or {} MiB are scheduled; further ones are applied now",
                           ScheduledCommands::kMaxCommands, ScheduledCommands::kMaxBytes >> 20);
      });
      break;
    case ScheduledCommands::ScheduleResult::now:
      break;
  }
  push(std::move(command), urgent_pushed);
}

void Receiver::process_pending() {
  decode_slice();
  while (std::optional<engine::Command> command = scheduled_.pop_due()) {
    command->arrival = 0;  // it counts as arriving now
    push(std::move(*command));
  }
  if (std::exchange(wake_pending_, false)) link_.wake_engine();
}

void Receiver::push(engine::Command command, bool urgent_pushed) {
  const std::size_t count = command.messages.size();
  if (link_.command_queue.push(std::move(command), urgent_pushed)) {
    wake_pending_ = true;
    return;
  }
  link_.counters.dropped.fetch_add(count, std::memory_order_relaxed);
  warn_throttled(queue_full_log_, [] { return kQueueFullText; });
}

void Receiver::reject(const CommandOrigin& origin, const std::string& address, const std::string& text) {
  link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
  callbacks_.error({engine::Outgoing::Destination::error, origin, engine::error_message(address, text)});
}

void Receiver::record_kernel_drops(ListenSocket& socket, std::uint32_t count) {
  // unsigned arithmetic is correct even if the kernel's counter wraps
  const std::uint32_t new_drops = count - socket.kernel_drops;
  socket.kernel_drops = count;
  if (new_drops == 0) return;
  link_.counters.dropped_kernel.fetch_add(new_drops, std::memory_order_relaxed);
  warn_throttled(kernel_drops_log_, [&] {
    return fmt::format(
        "OSC in {}: the system dropped {}. Increase net.core.rmem_max, or send bundles instead of single "
        "messages",
        endpoint_text(socket.socket.local()), counted(new_drops, "datagram"));
  });
}

int Receiver::socket_of(const Endpoint& sender) const {
  const KnownSender& known = known_senders_[slot_of(sender) % kKnownSlots];
  if (known.sender != sender) return -1;
  // the socket may have been closed and its descriptor reused
  const bool ours = std::ranges::any_of(sockets_, [&](const auto& s) { return s->socket.fd() == known.fd; });
  return ours ? known.fd : -1;
}

bool Receiver::allowed(const IpAddress& ip) const { return is_allowed(allow_, ip); }

}  // namespace limber::osc
