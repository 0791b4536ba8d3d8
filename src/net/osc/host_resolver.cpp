// The look-up threads and HostResolver share ownership of the results, so either may end first.
#include "net/osc/host_resolver.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/system/thread.h"
#include "base/text.h"

namespace limber::osc {

namespace {

constexpr IpAddress kThisMachine(0x7f000001U);
constexpr IpAddress kThisMachine6(0, 1);
constexpr std::int64_t kLookUpRetryInterval = 5'000'000'000;  // ns between two look-ups of an unknown name

std::optional<Endpoint> parse_literal(const std::string& host, std::uint16_t port, IpVersion preferred) {
  if (const std::optional<IpAddress> ip = parse_ip(host)) return Endpoint{*ip, port};
  if (host == "localhost") return Endpoint{preferred == IpVersion::v6 ? kThisMachine6 : kThisMachine, port};
  return std::nullopt;
}

}  // namespace

struct HostResolver::Shared {
  std::function<void()> notify;
  std::mutex mutex;  // guards the members below
  // by host and preferred kind of address; empty: pending
  std::map<std::pair<std::string, IpVersion>, std::optional<Result<Endpoint>>> results;
  bool changed = false;
  std::condition_variable look_up_ended;  // notified when a look-up ends

  std::size_t pending() const {
    return static_cast<std::size_t>(std::ranges::count_if(results, [](const auto& each) { return !each.second; }));
  }
};

HostResolver::HostResolver(ResolveFunction look_up, std::function<void()> notify)
    : look_up_(std::move(look_up)), shared_(std::make_shared<Shared>()) {
  shared_->notify = std::move(notify);
}

std::optional<Result<Endpoint>> HostResolver::find(const std::string& host, std::uint16_t port) {
  if (const std::optional<Endpoint> at = parse_literal(host, port, preferred_)) return *at;
  {
    const std::scoped_lock lock(shared_->mutex);
    const auto [entry, inserted] = shared_->results.try_emplace({host, preferred_});
    if (!inserted) {
      if (!entry->second || !entry->second->ok()) return entry->second;
      return Endpoint{(*entry->second)->ip, port};
    }
    if (shared_->pending() > kMaxLookUps) {
      shared_->results.erase(entry);
      return std::nullopt;
    }
  }
  const auto run_look_up = [host, port, preferred = preferred_, look_up = look_up_, shared = shared_] {
    Result<Endpoint> at = look_up(host, port, preferred);
    {
      const std::scoped_lock lock(shared->mutex);
      shared->results[{host, preferred}] = std::move(at);
      shared->changed = true;
    }
    shared->look_up_ended.notify_all();
    shared->notify();
  };
  if (std::thread thread; system::start_thread(thread, run_look_up)) {
    thread.detach();
  } else {
    run_look_up();  // no thread available: block this once
  }
  return std::nullopt;
}

std::optional<Result<Endpoint>> HostResolver::wait_until(std::chrono::steady_clock::time_point time,
                                                         const std::string& host, std::uint16_t port) {
  std::optional<Result<Endpoint>> at = find(host, port);
  while (!at && std::chrono::steady_clock::now() < time) {
    {
      std::unique_lock lock(shared_->mutex);
      shared_->look_up_ended.wait_until(lock, time, [&] {
        const auto entry = shared_->results.find({host, preferred_});
        return entry == shared_->results.end() ? shared_->pending() < kMaxLookUps : entry->second.has_value();
      });
    }
    at = find(host, port);
  }
  return at;
}

bool HostResolver::consume_changed() {
  const std::scoped_lock lock(shared_->mutex);
  return std::exchange(shared_->changed, false);
}

void HostResolver::invalidate() {
  const std::scoped_lock lock(shared_->mutex);
  std::erase_if(shared_->results, [](const auto& entry) { return entry.second.has_value(); });
}

void HostResolver::invalidate_failed() {
  const std::scoped_lock lock(shared_->mutex);
  std::erase_if(shared_->results, [](const auto& entry) { return entry.second && !entry.second->ok(); });
}

void TargetResolver::begin_config(IpVersion preferred) {
  host_names_.prefer(preferred);
  reported_errors_.clear();
  host_names_.invalidate();
}

std::vector<std::string> TargetResolver::resolve(const std::vector<StreamTarget>& configured, Sender& sender,
                                                 std::int64_t now, std::chrono::milliseconds wait) {
  std::vector<std::string> errors;
  targets_.clear();
  retry_at_.reset();
  const auto deadline = std::chrono::steady_clock::now() + wait;
  // all look-ups run at the same time
  for (const StreamTarget& config : configured) {
    if (wait.count() > 0) (void)host_names_.find(config.host, config.port);
  }
  for (const StreamTarget& config : configured) {
    const std::optional<Result<Endpoint>> endpoint = host_names_.wait_until(deadline, config.host, config.port);
    if (!endpoint) continue;
    if (*endpoint && sender.is_own_input(**endpoint)) {
      sender.report_own_input(**endpoint);
      continue;
    }
    if (*endpoint) {
      targets_.push_back({config, **endpoint});
      continue;
    }
    retry_at_ = now + kLookUpRetryInterval;
    std::string error =
        fmt::format("OSC out {}: {}; retried every 5 s. Correct the name in the scene or with --osc-out HOST:PORT",
                    host_port_text(printable(config.host), config.port), endpoint->error());
    if (std::ranges::find(reported_errors_, error) != reported_errors_.end()) continue;
    reported_errors_.push_back(error);
    errors.push_back(std::move(error));
  }
  sender.set_targets(targets_);
  return errors;
}

bool TargetResolver::consume_retry(std::int64_t now) {
  if (!retry_at_ || now < *retry_at_) return false;
  host_names_.invalidate_failed();
  return true;
}

}  // namespace limber::osc
