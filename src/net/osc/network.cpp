// The event loop of the network thread: one poll, then one pass over all sources of work.
#include "net/osc/network.h"

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/log/log.h"
#include "base/system/net/interfaces.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber::osc {

namespace {

constexpr std::chrono::seconds kStartLookUpTimeout{2};  // maximum time that start() waits for look-ups
constexpr std::size_t kMessagesPerPass = 256;           // messages sent per pass, so that input is not delayed
constexpr std::size_t kUnlimited = ~std::size_t{0};

// From the system's entropy source, so that tokens can't be predicted.
std::array<std::uint64_t, 2> secret() {
  std::random_device device;
  const auto word = [&device] { return std::uint64_t{device()} << 32 | device(); };
  return {word(), word()};
}

}  // namespace

void NetworkStatus::set(std::vector<Endpoint> bound, std::vector<Endpoint> bound_tcp,
                        const std::vector<ResolvedTarget>& targets) {
  const std::scoped_lock lock(mutex_);
  bound_ = std::move(bound);
  bound_tcp_ = std::move(bound_tcp);
  lines_.clear();
  for (const Endpoint& endpoint : bound_) lines_.push_back("OSC in " + endpoint_text(endpoint));
  for (const Endpoint& endpoint : bound_tcp_) lines_.push_back("OSC in " + endpoint_text(endpoint) + " (TCP)");
  if (bound_.empty() && bound_tcp_.empty()) lines_.emplace_back("OSC in off");
  for (const ResolvedTarget& target : targets) lines_.push_back("OSC out " + target_text(target.config));
  if (targets.empty()) lines_.emplace_back("OSC out off");
}

void NetworkStatus::clear() {
  const std::scoped_lock lock(mutex_);
  lines_.clear();
  bound_.clear();
  bound_tcp_.clear();
}

std::vector<std::string> NetworkStatus::lines() const {
  const std::scoped_lock lock(mutex_);
  return lines_;
}

std::vector<Endpoint> NetworkStatus::bound() const {
  const std::scoped_lock lock(mutex_);
  return bound_;
}

std::vector<Endpoint> NetworkStatus::bound_tcp() const {
  const std::scoped_lock lock(mutex_);
  return bound_tcp_;
}

void Outbox::send(Sender& sender, std::size_t max_messages) {
  while (max_messages > 0) {
    if (!has_unsent()) {
      next_ = 0;
      link_.output_queue.drain(messages_);
      if (messages_.empty()) return;
    }
    const std::size_t end = std::min(messages_.size(), next_ + std::min(max_messages, messages_.size()));
    max_messages -= end - next_;
    for (; next_ < end; next_++) sender.send(messages_[next_]);
  }
}

Network::Network(engine::EngineLink& link, OscOptions options, const engine::TransientOffsets& offsets, NetClock clock,
                 ResolveFunction look_up)
    : link_(link),
      options_(std::move(options)),
      clock_(std::move(clock)),
      wake_(std::make_shared<system::Wake>()),
      receiver_(
          link, options_.allow,
          {.error =
               [this](const engine::Outgoing& out) {
                 out.origin.source == CommandSource::oscquery ? link_.push_out(out) : sender_.send(out);
               },
           .pong = [this](const CommandOrigin& to) { pong(to); },
           .subscribe = [this](const Message& message,
                               const CommandOrigin& origin) { return subscribe(message, origin); },
           .is_subscriber = [this](const CommandOrigin& origin) { return subscribers_.is_subscriber(origin); },
           .received = [this](const Endpoint& from, std::size_t bytes) { record_received(from, bytes); },
           .token = [this](const Message& message, const CommandOrigin& origin) { handle_token(message, origin); },
           .error_answered =
               [this](const CommandOrigin& origin) {
                 if (origin.source == CommandSource::osc) sender_.record_error_answer({origin.ip, origin.port});
               }},
          clock_),
      tcp_(tcp_callbacks(), clock_),
      sender_(
          link.counters, link.message_log, [this](const Endpoint& sender) { return receiver_.socket_of(sender); },
          clock_),
      targets_(std::move(look_up), [wake = wake_] { wake->notify(); }),
      streams_(link, offsets, clock_, subscription_gate()),
      subscribers_(link, clock_,
                   [this](const engine::Outgoing& out) {
                     if (out.destination == engine::Outgoing::Destination::reply) return sender_.send_value(out);
                     sender_.send(out);
                     return true;
                   }),
      outbox_(link),
      amplification_(options_.allow, options_.connected ? options_.connected : connected_subnets, secret()) {
  // a connection proves that its client has the address
  sender_.set_gates(
      [this](const Endpoint& to, std::size_t bytes, std::size_t) {
        return tcp_.is_connected(to) || amplification_.try_send(to, bytes, clock_.steady());
      },
      subscription_gate());
  sender_.set_tcp(tcp_);
  streams_.set_tcp(tcp_);
  link_.wake_network = [wake = wake_] { wake->notify(); };
  link_.on_osc_request = [this](const Message& message, const CommandOrigin& origin) {
    Result<void> accepted = config_.edits.push(message, origin);
    wake_->notify();
    return accepted;
  };
}

Network::~Network() {
  stop();
  link_.on_osc_request = nullptr;
}

Result<void> Network::start() {
  if (thread_.joinable()) return {};
  config_.scene = link_.osc_config.read();
  std::vector<std::string> errors;
  if (const Result<void> opened = sender_.open(); !opened) errors.push_back(opened.error());
  std::ranges::move(apply(edited_config()), std::back_inserter(errors));
  std::ranges::move(tcp_.listen(options_.tcp), std::back_inserter(errors));
  // a machine that has just booted may not resolve names yet
  for (const std::string& error : resolve_targets(kStartLookUpTimeout)) log_warning("{}", error);
  if (!errors.empty() && !options_.optional) {
    stop();
    return Error{fmt::format("{}", fmt::join(errors, "\n"))};
  }
  for (const std::string& error : errors) log_warning("{}", error);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  return {};
}

void Network::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    wake_->notify();
    thread_.join();
  }
  // send the engine's last messages
  if (sender_.socket().is_open()) outbox_.send(sender_, kUnlimited);
  receiver_.close();
  tcp_.close();
  sender_.close();
  config_.current = {};
  streams_.set_targets({});
  status_.clear();
}

void Network::run(const std::stop_token& stop) {
  system::name_this_thread("limber-network");
  while (!stop.stop_requested()) {
    wait_for_events();
    wake_->clear();
    for (const int fd : receiver_.descriptors()) receiver_.receive(fd);
    process_packets();
    if (tcp_.work()) update_status_lines();
    receiver_.process_pending();
    apply_new_config();
    retry_listen();
    retry_look_ups();
    subscribers_.work();
    update_subscribers();
    publish_health();  // before the answers, so that a client that has received one finds the counts
    outbox_.send(sender_, kMessagesPerPass);
    streams_.send_due(sender_.socket());
    unreachable_.poll(sender_.socket(), link_.counters, clock_.steady());
    publish_health();  // sending may have withheld datagrams
  }
}

void Network::wait_for_events() {
  std::vector<system::PollEntry> descriptors;
  descriptors.push_back({.fd = wake_->fd()});
  for (const int fd : receiver_.descriptors()) descriptors.push_back({.fd = fd});
  tcp_.add_poll_entries(descriptors);
  std::optional<std::int64_t> timeout = streams_.timeout();
  std::optional<std::int64_t> look_up = targets_.retry_at();
  if (look_up) *look_up = std::max<std::int64_t>(0, *look_up - clock_.steady());
  std::optional<std::int64_t> unsent;
  if (outbox_.has_unsent()) unsent = 0;
  for (const auto other : {receiver_.timeout(), tcp_.timeout(), subscribers_.timeout(), look_up, unsent}) {
    if (other && (!timeout || *other < *timeout)) timeout = other;
  }
  std::optional<std::chrono::nanoseconds> limit;
  if (timeout) limit = std::chrono::nanoseconds(*timeout);
  // the result does not matter, because each pass checks all sources
  (void)system::wait_ready(descriptors, limit);
}

// Opens and closes the ports that differ from the previous configuration. Returns the errors. Call resolve_targets()
// next.
std::vector<std::string> Network::apply(const OscConfig& config) {
  std::vector<std::string> errors = receiver_.listen(config.listen);
  config_.current = config;
  update_own_endpoints();
  targets_.begin_config(is_ipv6_only(config_.current) ? IpVersion::v6 : IpVersion::v4);
  return errors;
}

// Returns the errors, each once per configuration.
std::vector<std::string> Network::resolve_targets(std::chrono::milliseconds wait) {
  std::vector<std::string> errors = targets_.resolve(config_.current.targets, sender_, clock_.steady(), wait);
  update_streams();
  update_status_lines();
  return errors;
}

void Network::update_status_lines() {
  status_.set(receiver_.bound(), tcp_.bound(), targets_.targets());
  link_.osc.set_targets(targets_text(config_.current.targets));
}

TcpCallbacks Network::tcp_callbacks() {
  const auto origin = [](const Endpoint& peer) { return CommandOrigin{CommandSource::osc, peer.ip, peer.port}; };
  return {.is_allowed = [this](const IpAddress& ip) { return is_allowed(options_.allow, ip); },
          .receive =
              [this, origin](const Endpoint& from, std::string_view packet) {
                const Receiver::ScanResult scanned = receiver_.scan(packet.data(), packet.size(), origin(from));
                if (scanned.urgent) link_.wake_engine();
                receiver_.process(packet.data(), packet.size(), origin(from), scanned);
              },
          .closed =
              [this, origin](const Endpoint& peer) {
                (void)subscribers_.handle({"/unsubscribe", {}}, origin(peer));
              }};
}

void Network::apply_new_config() {
  const bool resolved = targets_.consume_changed();
  std::shared_ptr<const OscConfig> scene_config = link_.osc_config.read();
  const bool received = scene_config != config_.scene;
  config_.scene = std::move(scene_config);
  const bool edited = process_target_requests();
  const OscConfig config = received || edited ? edited_config() : config_.current;
  const bool changed = config != config_.current;
  if (!changed && !resolved) return;
  const std::vector<std::string> before = status_lines();
  std::vector<std::string> errors;
  if (changed) errors = apply(config);
  std::ranges::move(resolve_targets(), std::back_inserter(errors));
  for (const std::string& error : errors) log_error("{}", error);
  if (!changed && status_lines() == before) return;  // a host name is still not found
  for (const std::string& line : status_lines()) log_info("{}", line);
}

// Returns true if targets may have changed.
bool Network::process_target_requests() {
  bool edited = false;
  for (const TargetEdits::Request& request : config_.edits.drain()) {
    if (same_address(request.message.address, "/list/targets")) {
      Message answer{"/list/targets", {}};
      for (const StreamTarget& target : edited_config().targets)
        answer.args.push_back(Arg::of(std::string_view(target_text(target))));
      if (answer.args.empty()) answer.args.push_back(Arg::of(""));  // an answer must not look like a query
      link_.push_out({engine::Outgoing::Destination::reply, request.origin, std::move(answer)});
      continue;
    }
    const Result<void> done = handle_target_request(request);
    edited = edited || done.ok();
    if (done) continue;
    link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    log_warning("OSC {} from {}: {}", request.message.address, sender_text(request.origin), done.error());
    link_.push_out({engine::Outgoing::Destination::error, request.origin,
                    engine::error_message(request.message.address, done.error())});
  }
  return edited;
}

// A forged sender must not direct streams to a machine that has not asked for them.
Result<void> Network::handle_target_request(const TargetEdits::Request& request) {
  const CommandOrigin& origin = request.origin;
  if (origin.source == CommandSource::osc && !origin.ip.is_any() && !tcp_.is_connected({origin.ip, origin.port}) &&
      !amplification_.is_unlimited(origin.ip, clock_.steady()))
    return Error{"a sender in another network must return its /token first, or be in --osc-allow"};
  return config_.edits.execute(request.message, edited_config().targets);
}

// The configuration of the command line or the scene, with the targets that messages have changed.
OscConfig Network::edited_config() const {
  OscConfig config = effective_config(options_, config_.scene.get());
  config.targets = config_.edits.applied_to(std::move(config.targets));
  return config;
}

// Repeats failed look-ups. Their errors were already logged.
void Network::retry_look_ups() {
  if (targets_.consume_retry(clock_.steady())) (void)resolve_targets();
}

void Network::retry_listen() {
  if (!receiver_.retry_listen(config_.current.listen)) return;
  update_own_endpoints();
  update_status_lines();
  for (const std::string& line : status_lines()) log_info("{}", line);
}

void Network::update_streams() {
  std::vector<ResolvedTarget> all = targets_.targets();
  std::ranges::move(subscribers_.targets(), std::back_inserter(all));
  streams_.set_targets(all);
}

void Network::update_subscribers() {
  if (!subscribers_.consume_changed()) return;
  sender_.set_subscribers(subscribers_.endpoints());
  update_streams();
}

bool Network::enqueue(const CommandOrigin& origin, std::string packet) {
  const Receiver::ScanResult scanned = receiver_.scan(packet.data(), packet.size(), origin);
  if (scanned.urgent) link_.wake_engine();
  if (!packets_.push({origin, std::move(packet), scanned})) {
    link_.counters.dropped.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  wake_->notify();
  return true;
}

void Network::process_packets() {
  for (const PacketQueue::Packet& p : packets_.drain())
    receiver_.process(p.bytes.data(), p.bytes.size(), p.origin, p.scanned);
}

void Network::pong(const CommandOrigin& to) {
  const std::shared_ptr<const engine::Snapshot> newest = link_.snapshots.read();
  const std::uint64_t tick = newest ? newest->tick : 0;
  const double time = newest ? newest->time : 0;
  if (to.source != CommandSource::oscquery) return sender_.pong(to, tick, time);
  link_.push_out(
      {engine::Outgoing::Destination::reply, to, {"/pong", {Arg::of(static_cast<double>(tick)), Arg::of(time)}}});
}

void Network::update_own_endpoints() {
  std::vector<IpAddress> addresses = {0xffffffffU};  // broadcasts return to this machine
  for (const system::Subnet& subnet : system::connected_subnets()) {
    addresses.push_back(subnet.ip);
    addresses.push_back(subnet.broadcast());
  }
  sender_.set_own_inputs(receiver_.bound(), std::move(addresses));
}

SendGate Network::subscription_gate() {
  return [this](const Endpoint& to, std::size_t bytes, std::size_t datagrams) {
    return subscribers_.try_consume(to, bytes, datagrams) &&
           (tcp_.is_connected(to) || amplification_.try_send(to, bytes, clock_.steady()));
  };
}

// Called before the datagram's messages are answered.
void Network::record_received(const Endpoint& from, std::size_t bytes) {
  amplification_.add_credit(from.ip, bytes, clock_.steady());
  challenge(from, false);
}

void Network::challenge(const Endpoint& peer, bool is_subscribing) {
  const std::optional<std::string> token = amplification_.make_challenge(peer.ip, is_subscribing, clock_.steady());
  if (token)
    sender_.send({engine::Outgoing::Destination::reply,
                  {CommandSource::osc, peer.ip, peer.port},
                  {"/token", {Arg::of(*token)}}});
}

void Network::handle_token(const Message& message, const CommandOrigin& origin) {
  if (origin.source != CommandSource::osc || message.args.size() != 1 || !message.args[0].is_text()) return;
  if (amplification_.verify_token(origin.ip, message.args[0].text, clock_.steady()))
    log_info("OSC out: {} has returned its token and is no longer limited", endpoint_text({origin.ip, origin.port}));
}

Result<void> Network::subscribe(const Message& message, const CommandOrigin& origin) {
  const Endpoint peer{origin.ip, origin.port};
  if (origin.source == CommandSource::osc && sender_.is_own_input(peer)) {
    sender_.report_own_input(peer);
    return {};
  }
  if (origin.source == CommandSource::osc && !tcp_.is_connected(peer)) challenge(peer, true);
  return subscribers_.handle(message, origin);
}

void Network::publish_health() {
  link_.health.set(engine::HealthItem::limited, amplification_.withheld());
  link_.health.set(engine::HealthItem::loops, sender_.loops());
}

}  // namespace limber::osc
