// HostResolver: resolves host names off the network thread, because a name server may block for seconds.
// TargetResolver: the stream targets with resolved addresses.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "net/osc/endpoint.h"
#include "net/osc/sender.h"

namespace limber::osc {

/// Resolves a host and a port to an address: resolve(), or a replacement in tests.
using ResolveFunction =
    std::function<Result<Endpoint>(const std::string& host, std::uint16_t port, IpVersion preferred)>;

/// Asynchronous host name look-ups with a cache. [net]; each look-up runs on its own detached thread.
class HostResolver {
 public:
  /// `notify` is called on the look-up's thread when a look-up ends, even after this object was destroyed.
  HostResolver(ResolveFunction look_up, std::function<void()> notify);

  static constexpr std::size_t kMaxLookUps = 16;  ///< At the same time; further ones begin when others end.

  /// Returns numeric addresses and "localhost" immediately, other names once their look-up has ended. Returns an empty
  /// optional while the look-up is pending, or waits for others to end.
  std::optional<Result<Endpoint>> find(const std::string& host, std::uint16_t port);
  /// As find(), but waits for the look-up until `time`.
  std::optional<Result<Endpoint>> wait_until(std::chrono::steady_clock::time_point time, const std::string& host,
                                             std::uint16_t port);
  /// True if a look-up has ended since the last call.
  bool consume_changed();
  /// Sets the kind of address of names that have both. Call invalidate() next.
  void prefer(IpVersion version) { preferred_ = version; }
  /// Discards all finished look-ups, so that names are resolved again: a machine may have moved.
  void invalidate();
  /// Discards failed look-ups, so that these names are resolved again.
  void invalidate_failed();

 private:
  struct Shared;
  ResolveFunction look_up_;
  IpVersion preferred_ = IpVersion::v4;
  std::shared_ptr<Shared> shared_;
};

/// The stream targets of a configuration with their addresses. Look-ups of unknown names are repeated every 5 s. [net]
class TargetResolver {
 public:
  /// As HostResolver.
  TargetResolver(ResolveFunction look_up, std::function<void()> notify)
      : host_names_(std::move(look_up), std::move(notify)) {}

  /// Before the first resolve() of a configuration: resolves all names again. `preferred`: for names with addresses of
  /// both kinds.
  void begin_config(IpVersion preferred);
  /// Sets the targets that have a resolved address and are not an own input of the sender. Waits for the look-ups up to
  /// `wait` in all. Returns the errors, each once per configuration. `now` in ns.
  std::vector<std::string> resolve(const std::vector<StreamTarget>& configured, Sender& sender, std::int64_t now,
                                   std::chrono::milliseconds wait = {});
  const std::vector<ResolvedTarget>& targets() const { return targets_; }

  /// True if a look-up has ended since the last call.
  bool consume_changed() { return host_names_.consume_changed(); }
  /// True if it is time to repeat failed look-ups: call resolve(). Their errors were already returned.
  bool consume_retry(std::int64_t now);
  /// Time of the next consume_retry() in ns; empty if none is expected.
  std::optional<std::int64_t> retry_at() const { return retry_at_; }

 private:
  HostResolver host_names_;
  std::vector<ResolvedTarget> targets_;
  std::vector<std::string> reported_errors_;  // errors of this configuration
  std::optional<std::int64_t> retry_at_;
};

}  // namespace limber::osc
