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

namespace limber {

namespace {

constexpr std::int64_t kListenRetryInterval = 1'000'000'000;  // ns between two attempts to open a port
constexpr std::int64_t kLookUpRetryInterval = 5'000'000'000;  // ns between two look-ups of an unknown name
constexpr std::chrono::seconds kStartLookUpTimeout{2};        // maximum time that start() waits for look-ups
constexpr std::size_t kMessagesPerPass = 256;                 // messages sent per pass, so that input is not delayed
constexpr std::size_t kUnlimited = ~std::size_t{0};

// From the system's entropy source, so that tokens can't be predicted.
std::array<std::uint64_t, 2> secret() {
  std::random_device device;
  const auto word = [&device] { return std::uint64_t{device()} << 32 | device(); };
  return {word(), word()};
}

}  // namespace

Network::Network(EngineLink& link, OscOptions options, const TransientOffsets& offsets, NetClock clock,
                 ResolveFunction look_up)
    : link_(link),
      options_(std::move(options)),
      clock_(std::move(clock)),
      wake_(std::make_shared<system::Wake>()),
      receiver_(link, options_.allow,
                {[this](const Outgoing& out) {
                   out.origin.source == CommandSource::oscquery ? link_.push_out(out) : sender_.send(out);
                 },
                 [this](const CommandOrigin& to) { pong(to); },
                 [this](const Message& message, const CommandOrigin& origin) { return subscribe(message, origin); },
                 [this](const CommandOrigin& origin) { return subscribers_.is_subscriber(origin); },
                 [this](const Endpoint& from, std::size_t bytes) { record_received(from, bytes); },
                 [this](const Message& message, const CommandOrigin& origin) { handle_token(message, origin); },
                 [this](const CommandOrigin& origin) {
                   if (origin.source == CommandSource::osc) sender_.record_error_answer({origin.ip, origin.port});
                 }},
                clock_),
      sender_(
          link.counters, link.message_log, [this](const Endpoint& sender) { return receiver_.socket_of(sender); },
          clock_),
      host_names_(std::move(look_up), [wake = wake_] { wake->notify(); }),
      streams_(link, offsets, clock_, subscription_gate()),
      subscribers_(link, clock_,
                   [this](const Outgoing& out) {
                     if (out.destination == Outgoing::Destination::sender) return sender_.send_value(out);
                     sender_.send(out);
                     return true;
                   }),
      amplification_(options_.allow, options_.connected ? options_.connected : connected_subnets, secret()) {
  sender_.set_gates([this](const Endpoint& to, std::size_t bytes, std::size_t) { return may_send(to, bytes); },
                    subscription_gate());
  link_.wake_network = [wake = wake_] { wake->notify(); };
}

Network::~Network() { stop(); }

Result<void> Network::start() {
  if (thread_.joinable()) return {};
  last_config_ = link_.osc_config.read();
  std::vector<std::string> faults;
  if (const Result<void> opened = sender_.open(); !opened) faults.push_back(opened.error());
  std::ranges::move(apply(effective_config(options_, last_config_.get())), std::back_inserter(faults));
  // a machine that has just booted may not resolve names yet
  for (const std::string& fault : resolve_targets(kStartLookUpTimeout)) log_warning("{}", fault);
  if (!faults.empty() && !options_.optional) {
    stop();
    return Error{fmt::format("{}", fmt::join(faults, "\n"))};
  }
  for (const std::string& fault : faults) log_warning("{}", fault);
  stop_ = false;
  thread_ = std::thread([this] { run(); });
  return {};
}

void Network::stop() {
  if (thread_.joinable()) {
    stop_ = true;
    wake_->notify();
    thread_.join();
  }
  // send the engine's last messages
  if (sender_.socket().is_open()) send_outbox(kUnlimited);
  receiver_.close();
  sender_.close();
  config_ = {};
  streams_.set_targets({});
  const std::scoped_lock lock(status_mutex_);
  status_lines_.clear();
  bound_.clear();
}

std::vector<std::string> Network::status_lines() const {
  const std::scoped_lock lock(status_mutex_);
  return status_lines_;
}

std::vector<Endpoint> Network::bound() const {
  const std::scoped_lock lock(status_mutex_);
  return bound_;
}

void Network::run() {
  system::name_this_thread("limber-network");
  while (!stop_.load()) {
    wait_for_events();
    wake_->clear();
    for (const int fd : descriptors_) receiver_.receive(fd);
    process_packets();
    receiver_.process_pending();
    apply_new_config();
    retry_listen();
    retry_look_ups();
    subscribers_.work();
    update_subscribers();
    publish_health();
    send_outbox(kMessagesPerPass);
    streams_.send_due(sender_.socket());
    unreachable_.poll(sender_.socket(), link_.counters, clock_.steady());
    publish_health();
  }
}

void Network::wait_for_events() {
  std::vector<system::PollEntry> descriptors;
  descriptors.push_back({.fd = wake_->fd()});
  for (const int fd : descriptors_) descriptors.push_back({.fd = fd});
  std::optional<std::int64_t> timeout = streams_.timeout();
  const auto remaining = [this](std::optional<std::int64_t> at) {
    if (at) *at = std::max<std::int64_t>(0, *at - clock_.steady());
    return at;
  };
  std::optional<std::int64_t> unsent;
  if (next_outgoing_ < outgoing_.size()) unsent = 0;
  for (const auto other : {receiver_.timeout(), subscribers_.timeout(), remaining(retry_listen_at_),
                           remaining(retry_look_ups_at_), unsent}) {
    if (other && (!timeout || *other < *timeout)) timeout = other;
  }
  std::optional<std::chrono::nanoseconds> limit;
  if (timeout) limit = std::chrono::nanoseconds(*timeout);
  // the result does not matter, because each pass checks all sources
  (void)system::wait_ready(descriptors, limit);
}

// Opens and closes the ports that differ from the previous plan. Returns the errors. Call resolve_targets() next.
std::vector<std::string> Network::apply(const OscConfig& plan) {
  std::vector<std::string> faults = receiver_.listen(plan.listen);
  descriptors_ = receiver_.descriptors();
  retry_listen_at_.reset();
  if (receiver_.has_unopened(plan.listen)) retry_listen_at_ = clock_.steady() + kListenRetryInterval;
  config_ = plan;
  reported_faults_.clear();
  update_own_endpoints();
  host_names_.invalidate();
  return faults;
}

// Sets the targets that have a resolved address. Returns the errors, each once per plan.
std::vector<std::string> Network::resolve_targets(std::chrono::milliseconds wait) {
  std::vector<std::string> faults;
  targets_.clear();
  retry_look_ups_at_.reset();
  for (const StreamTarget& config : config_.targets) {
    const std::optional<Result<Endpoint>> endpoint = wait.count() > 0
                                                         ? host_names_.wait_for(config.host, config.port, wait)
                                                         : host_names_.find(config.host, config.port);
    if (!endpoint) continue;
    if (*endpoint && sender_.is_own_input(**endpoint)) {
      sender_.report_own_input(**endpoint);
      continue;
    }
    if (*endpoint) {
      targets_.push_back({config, **endpoint});
      continue;
    }
    retry_look_ups_at_ = clock_.steady() + kLookUpRetryInterval;
    std::string fault =
        fmt::format("OSC out {}:{}: {}; retried every 5 s. Correct the name in the scene or with --osc-out HOST:PORT",
                    printable(config.host), config.port, endpoint->error());
    if (std::ranges::find(reported_faults_, fault) != reported_faults_.end()) continue;
    reported_faults_.push_back(fault);
    faults.push_back(std::move(fault));
  }
  sender_.set_targets(targets_);
  update_streams();
  update_status_lines();
  return faults;
}

void Network::update_status_lines() {
  const std::scoped_lock lock(status_mutex_);
  bound_ = receiver_.bound();
  status_lines_.clear();
  for (const Endpoint& end : bound_) status_lines_.push_back("OSC in " + endpoint_text(end));
  if (bound_.empty()) status_lines_.emplace_back("OSC in off");
  for (const ResolvedTarget& target : targets_) status_lines_.push_back("OSC out " + target_text(target.config));
  if (targets_.empty()) status_lines_.emplace_back("OSC out off");
}

void Network::apply_new_config() {
  const bool resolved = host_names_.consume_changed();
  std::shared_ptr<const OscConfig> scene_config = link_.osc_config.read();
  const bool received = scene_config != last_config_;
  last_config_ = std::move(scene_config);
  const OscConfig plan = received ? effective_config(options_, last_config_.get()) : config_;
  const bool changed = plan != config_;
  if (!changed && !resolved) return;
  const std::vector<std::string> before = status_lines();
  std::vector<std::string> faults;
  if (changed) faults = apply(plan);
  std::ranges::move(resolve_targets(), std::back_inserter(faults));
  for (const std::string& fault : faults) log_error("{}", fault);
  if (!changed && status_lines() == before) return;  // a host name is still not found
  for (const std::string& line : status_lines()) log_info("{}", line);
}

// Repeats failed look-ups. Their errors were already logged.
void Network::retry_look_ups() {
  if (!retry_look_ups_at_ || clock_.steady() < *retry_look_ups_at_) return;
  host_names_.invalidate_failed();
  (void)resolve_targets();
}

// Retries ports that are in use or have an address that does not exist yet. Their errors were already logged.
void Network::retry_listen() {
  if (!retry_listen_at_ || clock_.steady() < *retry_listen_at_) return;
  (void)receiver_.listen(config_.listen);
  retry_listen_at_.reset();
  if (receiver_.has_unopened(config_.listen)) retry_listen_at_ = clock_.steady() + kListenRetryInterval;
  if (receiver_.descriptors() == descriptors_) return;
  descriptors_ = receiver_.descriptors();
  update_own_endpoints();
  update_status_lines();
  for (const std::string& line : status_lines()) log_info("{}", line);
}

void Network::update_streams() {
  std::vector<ResolvedTarget> all = targets_;
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
  packets_.drain(packet_batch_);
  for (const Packet& p : packet_batch_) receiver_.process(p.bytes.data(), p.bytes.size(), p.origin, p.scanned);
}

void Network::pong(const CommandOrigin& to) {
  const std::shared_ptr<const Snapshot> newest = link_.snapshots.read();
  const std::uint64_t tick = newest ? newest->tick : 0;
  const double time = newest ? newest->time : 0;
  if (to.source != CommandSource::oscquery) return sender_.pong(to, tick, time);
  link_.push_out({Outgoing::Destination::sender, to, {"/pong", {Arg::of(static_cast<double>(tick)), Arg::of(time)}}});
}

void Network::send_outbox(std::size_t max_messages) {
  while (max_messages > 0) {
    if (next_outgoing_ == outgoing_.size()) {
      next_outgoing_ = 0;
      link_.output_queue.drain(outgoing_);
      if (outgoing_.empty()) return;
    }
    const std::size_t end = std::min(outgoing_.size(), next_outgoing_ + std::min(max_messages, outgoing_.size()));
    max_messages -= end - next_outgoing_;
    for (; next_outgoing_ < end; next_outgoing_++) sender_.send(outgoing_[next_outgoing_]);
  }
}

void Network::update_own_endpoints() {
  std::vector<std::uint32_t> addresses;
  for (const system::Subnet& subnet : system::connected_subnets()) addresses.push_back(subnet.ip);
  sender_.set_own_inputs(receiver_.bound(), std::move(addresses));
}

SendGate Network::subscription_gate() {
  return [this](const Endpoint& to, std::size_t bytes, std::size_t datagrams) {
    return subscribers_.try_consume(to, bytes, datagrams) && may_send(to, bytes);
  };
}

bool Network::may_send(const Endpoint& to, std::size_t bytes) {
  if (amplification_.try_consume(to.ip, bytes, clock_.steady())) return true;
  if (const auto more = limited_log_.admit(clock_.steady())) {
    log_warning(
        "OSC out: {} is in another network and limited to three bytes for each byte received until it returns /token. "
        "--osc-allow {}/32 removes the limit{}",
        endpoint_text(to), system::endpoint_text({to.ip, 0}), *more);
  }
  return false;
}

// Called before the datagram's messages are answered.
void Network::record_received(const Endpoint& from, std::size_t bytes) {
  amplification_.add_credit(from.ip, bytes, clock_.steady());
  challenge(from, false);
}

void Network::challenge(const Endpoint& end, bool wants_more) {
  const std::optional<std::string> token = amplification_.make_challenge(end.ip, wants_more, clock_.steady());
  if (token)
    sender_.send(
        {Outgoing::Destination::sender, {CommandSource::osc, end.ip, end.port}, {"/token", {Arg::of(*token)}}});
}

void Network::handle_token(const Message& message, const CommandOrigin& origin) {
  if (origin.source != CommandSource::osc || message.args.size() != 1 || !message.args[0].is_text()) return;
  if (amplification_.verify_token(origin.ip, message.args[0].text, clock_.steady()))
    log_info("OSC out: {} has returned its token and is no longer limited", endpoint_text({origin.ip, origin.port}));
}

Result<void> Network::subscribe(const Message& message, const CommandOrigin& origin) {
  const Endpoint end{origin.ip, origin.port};
  if (origin.source == CommandSource::osc && sender_.is_own_input(end)) {
    sender_.report_own_input(end);
    return {};
  }
  if (origin.source == CommandSource::osc) challenge(end, true);
  return subscribers_.handle(message, origin);
}

void Network::publish_health() {
  link_.health.set(HealthItem::limited, amplification_.withheld());
  link_.health.set(HealthItem::loops, sender_.loops());
}

}  // namespace limber
