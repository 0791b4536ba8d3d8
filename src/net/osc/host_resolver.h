// HostResolver: resolves host names off the network thread, because a name server may block for seconds.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "net/osc/endpoint.h"

namespace limber {

/// Resolves a host and a port to an address: resolve(), or a replacement in tests.
using ResolveFunction = std::function<Result<Endpoint>(const std::string& host, std::uint16_t port)>;

/// Asynchronous host name look-ups with a cache. [net]; each look-up runs on its own detached thread.
class HostResolver {
 public:
  /// `notify` is called on the look-up's thread when a look-up ends, even after this object was destroyed.
  HostResolver(ResolveFunction look_up, std::function<void()> notify);

  /// Returns numeric addresses and "localhost" immediately, other names once their look-up has ended. Returns an empty
  /// optional while the look-up is pending.
  std::optional<Result<Endpoint>> find(const std::string& host, std::uint16_t port);
  /// As find(), but waits for the look-up up to `limit`. [main, before the network thread runs]
  std::optional<Result<Endpoint>> wait_for(const std::string& host, std::uint16_t port,
                                           std::chrono::milliseconds limit);
  /// True if a look-up has ended since the last call.
  bool consume_changed();
  /// Discards all finished look-ups, so that names are resolved again: a machine may have moved.
  void invalidate();
  /// Discards failed look-ups, so that these names are resolved again.
  void invalidate_failed();

 private:
  struct Shared;
  ResolveFunction look_up_;
  std::shared_ptr<Shared> shared_;
};

}  // namespace limber
