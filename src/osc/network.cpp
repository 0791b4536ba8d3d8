// One loop, one poll: everything that OSC does happens between two waits.
#include "osc/network.h"

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/log.h"
#include "base/system/interfaces.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::int64_t kListenPause = 1'000'000'000;  // ns between two tries to open a port that is taken
constexpr std::int64_t kNamePause = 5'000'000'000;    // ns between two look-ups of a name that is not known yet
constexpr std::chrono::seconds kFirstLookUp{2};       // that the start waits for
constexpr std::size_t kOutboxSlice = 256;             // messages that go out before input gets its turn
constexpr std::size_t kAll = ~std::size_t{0};

// from the system, so that nobody can compute the tokens
std::array<std::uint64_t, 2> secret() {
  std::random_device device;
  const auto word = [&device] { return std::uint64_t{device()} << 32 | device(); };
  return {word(), word()};
}

}  // namespace

Network::Network(EngineLink& link, OscOptions options, const LiveOffsets& offsets, NetClock clock, LookUp look_up)
    : link_(link),
      options_(std::move(options)),
      clock_(std::move(clock)),
      wake_(std::make_shared<system::Wake>()),
      receiver_(
          link, options_.allow,
          {[this](const Outgoing& out) { out.origin.hand == Hand::query ? link_.push_out(out) : sender_.send(out); },
           [this](const Origin& to) { pong(to); },
           [this](const Message& message, const Origin& origin) { return subscribe(message, origin); },
           [this](const Origin& origin) { return subscribers_.follows(origin); },
           [this](const Endpoint& from, std::size_t bytes) { note_received(from, bytes); },
           [this](const Message& message, const Origin& origin) { take_token(message, origin); },
           [this](const Origin& origin) {
             if (origin.hand == Hand::osc) sender_.note_echo({origin.ip, origin.port});
           }},
          clock_),
      sender_(
          link.counters, link.traffic, [this](const Endpoint& sender) { return receiver_.socket_of(sender); }, clock_),
      names_(std::move(look_up), [wake = wake_] { wake->notify(); }),
      streams_(link, offsets, clock_, serves()),
      subscribers_(link, clock_,
                   [this](const Outgoing& out) {
                     if (out.to == Outgoing::To::sender) return sender_.send_value(out);
                     sender_.send(out);
                     return true;
                   }),
      sources_(options_.allow, options_.connected ? options_.connected : connected_subnets, secret()) {
  sender_.set_gates([this](const Endpoint& to, std::size_t bytes, std::size_t) { return may_send(to, bytes); },
                    serves());
  link_.wake_network = [wake = wake_] { wake->notify(); };
}

Network::~Network() { stop(); }

Result<void> Network::start() {
  if (thread_.joinable()) return {};
  seen_plan_ = link_.osc_plan.read();
  std::vector<std::string> faults;
  if (const Result<void> opened = sender_.open(); !opened) faults.push_back(opened.error());
  std::ranges::move(apply(effective_plan(options_, seen_plan_.get())), std::back_inserter(faults));
  // a machine that has just been switched on may know no names yet
  for (const std::string& fault : aim(kFirstLookUp)) log_warning("{}", fault);
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
  // what the engine said before it stopped still goes out
  if (sender_.socket().is_open()) send_outbox(kAll);
  receiver_.close();
  sender_.close();
  plan_ = {};
  streams_.set_targets({});
  const std::scoped_lock lock(status_mutex_);
  lines_.clear();
  bound_.clear();
}

std::vector<std::string> Network::lines() const {
  const std::scoped_lock lock(status_mutex_);
  return lines_;
}

std::vector<Endpoint> Network::bound() const {
  const std::scoped_lock lock(status_mutex_);
  return bound_;
}

void Network::run() {
  system::name_this_thread("limber-network");
  while (!stop_.load()) {
    wait_for_something();
    wake_->clear();
    for (const int fd : descriptors_) receiver_.receive(fd);
    take_packets();
    receiver_.release_due();
    apply_new_plan();
    listen_again();
    look_up_again();
    subscribers_.work();
    aim_at_subscribers();
    tell_health();
    send_outbox(kOutboxSlice);
    streams_.send_due(sender_.socket());
    refusals_.take(sender_.socket(), link_.counters, clock_.steady());
    tell_health();
  }
}

void Network::wait_for_something() {
  std::vector<system::Waiting> waiting;
  waiting.push_back({.fd = wake_->fd()});
  for (const int fd : descriptors_) waiting.push_back({.fd = fd});
  std::optional<std::int64_t> wait = streams_.wait();
  const auto until = [this](std::optional<std::int64_t> at) {
    if (at) *at = std::max<std::int64_t>(0, *at - clock_.steady());
    return at;
  };
  std::optional<std::int64_t> unsent;
  if (next_outgoing_ < outgoing_.size()) unsent = 0;
  for (const auto other : {receiver_.wait(), subscribers_.wait(), until(listen_at_), until(names_at_), unsent}) {
    if (other && (!wait || *other < *wait)) wait = other;
  }
  std::optional<std::chrono::nanoseconds> limit;
  if (wait) limit = std::chrono::nanoseconds(*wait);
  // interrupted or not: the loop looks at everything anyway
  (void)system::wait_ready(waiting, limit);
}

// opens and closes what differs from the plan before; the texts of what went wrong. aim() is next
std::vector<std::string> Network::apply(const OscPlan& plan) {
  std::vector<std::string> faults = receiver_.listen(plan.listen);
  descriptors_ = receiver_.descriptors();
  listen_at_.reset();
  if (receiver_.wants_more(plan.listen)) listen_at_ = clock_.steady() + kListenPause;
  plan_ = plan;
  said_.clear();
  set_own();
  names_.forget();
  return faults;
}

// sends to those of the plan's targets whose addresses are known; what went wrong, each once a plan
std::vector<std::string> Network::aim(std::chrono::milliseconds wait) {
  std::vector<std::string> faults;
  targets_.clear();
  names_at_.reset();
  for (const StreamTarget& wish : plan_.targets) {
    const std::optional<Result<Endpoint>> at =
        wait.count() > 0 ? names_.wait_for(wish.host, wish.port, wait) : names_.find(wish.host, wish.port);
    if (!at) continue;
    if (*at && sender_.is_own(**at)) {
      sender_.report_own(**at);
      continue;
    }
    if (*at) {
      targets_.push_back({wish, **at});
      continue;
    }
    names_at_ = clock_.steady() + kNamePause;
    std::string fault = fmt::format(
        "OSC can't stream to {}:{}: {}; it is looked up again every five seconds. Correct a wrong name in the scene or "
        "with --osc-out HOST:PORT",
        printable(wish.host), wish.port, at->error());
    if (std::ranges::find(said_, fault) != said_.end()) continue;
    said_.push_back(fault);
    faults.push_back(std::move(fault));
  }
  sender_.set_targets(targets_);
  aim_streams();
  renew_lines();
  return faults;
}

void Network::renew_lines() {
  const std::scoped_lock lock(status_mutex_);
  bound_ = receiver_.bound();
  lines_.clear();
  for (const Endpoint& end : bound_) lines_.push_back("OSC in " + endpoint_text(end));
  if (bound_.empty()) lines_.emplace_back("OSC in off");
  for (const Target& target : targets_) lines_.push_back("OSC out " + target_text(target.wish));
  if (targets_.empty()) lines_.emplace_back("OSC out off");
}

void Network::apply_new_plan() {
  const bool found = names_.take_news();
  std::shared_ptr<const OscPlan> wished = link_.osc_plan.read();
  const bool said = wished != seen_plan_;
  seen_plan_ = std::move(wished);
  const OscPlan plan = said ? effective_plan(options_, seen_plan_.get()) : plan_;
  const bool other = plan != plan_;
  if (!other && !found) return;
  const std::vector<std::string> before = lines();
  std::vector<std::string> faults;
  if (other) faults = apply(plan);
  std::ranges::move(aim(), std::back_inserter(faults));
  for (const std::string& fault : faults) log_error("{}", fault);
  if (!other && lines() == before) return;  // a name is not found still
  for (const std::string& line : lines()) log_info("{}", line);
}

// it was said that they are not found
void Network::look_up_again() {
  if (!names_at_ || clock_.steady() < *names_at_) return;
  names_.forget_failed();
  (void)aim();
}

// a port that another program holds, or an address that is not there yet: it was said, and is had when it is free
void Network::listen_again() {
  if (!listen_at_ || clock_.steady() < *listen_at_) return;
  (void)receiver_.listen(plan_.listen);
  listen_at_.reset();
  if (receiver_.wants_more(plan_.listen)) listen_at_ = clock_.steady() + kListenPause;
  if (receiver_.descriptors() == descriptors_) return;
  descriptors_ = receiver_.descriptors();
  set_own();
  renew_lines();
  for (const std::string& line : lines()) log_info("{}", line);
}

void Network::aim_streams() {
  std::vector<Target> all = targets_;
  std::ranges::move(subscribers_.targets(), std::back_inserter(all));
  streams_.set_targets(all);
}

void Network::aim_at_subscribers() {
  if (!subscribers_.take_news()) return;
  sender_.set_subscribers(subscribers_.ends());
  aim_streams();
}

bool Network::take(const Origin& origin, std::string packet) {
  const Receiver::Scanned scanned = receiver_.scan(packet.data(), packet.size(), origin);
  if (scanned.urgent) link_.wake_engine();
  if (!packets_.push({origin, std::move(packet), scanned})) {
    link_.counters.dropped.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  wake_->notify();
  return true;
}

void Network::take_packets() {
  packets_.drain(taken_);
  for (const Packet& p : taken_) receiver_.take(p.bytes.data(), p.bytes.size(), p.origin, p.scanned);
}

void Network::pong(const Origin& to) {
  const std::shared_ptr<const Snapshot> newest = link_.snapshots.read();
  const std::uint64_t tick = newest ? newest->tick : 0;
  const double time = newest ? newest->time : 0;
  if (to.hand != Hand::query) return sender_.pong(to, tick, time);
  link_.push_out({Outgoing::To::sender, to, {"/pong", {Arg::of(static_cast<double>(tick)), Arg::of(time)}}});
}

void Network::send_outbox(std::size_t most) {
  while (most > 0) {
    if (next_outgoing_ == outgoing_.size()) {
      next_outgoing_ = 0;
      link_.outbox.drain(outgoing_);
      if (outgoing_.empty()) return;
    }
    const std::size_t end = std::min(outgoing_.size(), next_outgoing_ + std::min(most, outgoing_.size()));
    most -= end - next_outgoing_;
    for (; next_outgoing_ < end; next_outgoing_++) sender_.send(outgoing_[next_outgoing_]);
  }
}

void Network::set_own() {
  std::vector<std::uint32_t> addresses;
  for (const system::Subnet& subnet : system::connected_subnets()) addresses.push_back(subnet.ip);
  sender_.set_own(receiver_.bound(), std::move(addresses));
}

SendGate Network::serves() {
  return [this](const Endpoint& to, std::size_t bytes, std::size_t datagrams) {
    return subscribers_.spend(to, bytes, datagrams) && may_send(to, bytes);
  };
}

bool Network::may_send(const Endpoint& to, std::size_t bytes) {
  if (sources_.allows(to.ip, bytes, clock_.steady())) return true;
  if (const auto more = limited_.ask(clock_.steady())) {
    log_warning(
        "OSC out: {} is in another network and gets at most three bytes for each that it sends, until it returns "
        "/token; --osc-allow {}/32 serves it in full{}",
        endpoint_text(to), system::endpoint_text({to.ip, 0}), *more);
  }
  return false;
}

// before its messages are answered
void Network::note_received(const Endpoint& from, std::size_t bytes) {
  sources_.received(from.ip, bytes, clock_.steady());
  challenge(from, false);
}

void Network::challenge(const Endpoint& end, bool wants_more) {
  const std::optional<std::string> token = sources_.token(end.ip, wants_more, clock_.steady());
  if (token) sender_.send({Outgoing::To::sender, {Hand::osc, end.ip, end.port}, {"/token", {Arg::of(*token)}}});
}

void Network::take_token(const Message& message, const Origin& origin) {
  if (origin.hand != Hand::osc || message.args.size() != 1 || !message.args[0].is_text()) return;
  if (sources_.accept(origin.ip, message.args[0].text, clock_.steady()))
    log_info("OSC: {} has returned its token and is served in full", endpoint_text({origin.ip, origin.port}));
}

Result<void> Network::subscribe(const Message& message, const Origin& origin) {
  const Endpoint end{origin.ip, origin.port};
  if (origin.hand == Hand::osc && sender_.is_own(end)) {
    sender_.report_own(end);
    return {};
  }
  if (origin.hand == Hand::osc) challenge(end, true);
  return subscribers_.take(message, origin);
}

void Network::tell_health() {
  link_.health.set(HealthItem::limited, sources_.withheld());
  link_.health.set(HealthItem::loops, sender_.loops());
}

}  // namespace limber
