// One loop, one poll: everything that OSC does happens between two waits.
#include "osc/network.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/log.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::int64_t kListenPause = 1'000'000'000;  // ns between two tries to open a port that is taken
constexpr std::int64_t kNamePause = 5'000'000'000;    // ns between two look-ups of a name that is not known yet
constexpr std::chrono::seconds kFirstLookUp{2};       // that the start waits for

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
           [this](const Message& message, const Origin& origin) { return subscribers_.take(message, origin); },
           [this](const Origin& origin) { return subscribers_.follows(origin); }},
          clock_),
      sender_(
          link.counters, link.traffic, [this](const Endpoint& sender) { return receiver_.socket_of(sender); }, clock_),
      names_(std::move(look_up), [wake = wake_] { wake->notify(); }),
      streams_(link, offsets, clock_),
      subscribers_(link, clock_, [this](const Outgoing& out) { sender_.send(out); }) {
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
  if (sender_.socket().is_open()) send_outbox();
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
    send_outbox();
    streams_.send_due(sender_.socket());
    refusals_.take(sender_.socket(), link_.counters, clock_.steady());
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
  for (const auto other : {receiver_.wait(), subscribers_.wait(), until(listen_at_), until(names_at_)}) {
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

void Network::send_outbox() {
  link_.outbox.drain(outgoing_);
  for (const Outgoing& out : outgoing_) sender_.send(out);
}

}  // namespace limber
