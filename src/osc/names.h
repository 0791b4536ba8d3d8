// HostNames: host names looked up off the network thread, since a name server may let one wait for seconds.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "osc/endpoint.h"

namespace limber {

/// How a host and a port become an address: resolve(), or a test's.
using LookUp = std::function<Result<Endpoint>(const std::string& host, std::uint16_t port)>;

/// [net], but for the look-ups, each of which has a thread of its own that nobody waits for.
class HostNames {
 public:
  /// `ring` is called, on a thread of the look-up's, when one has ended; also after this object is gone.
  HostNames(LookUp look_up, std::function<void()> ring);

  /// Numbers and "localhost" at once; a name when its look-up has ended. Nothing: it is on its way.
  std::optional<Result<Endpoint>> find(const std::string& host, std::uint16_t port);
  /// The same; waits for a look-up, but not longer than this. [main, before the network thread runs]
  std::optional<Result<Endpoint>> wait_for(const std::string& host, std::uint16_t port,
                                           std::chrono::milliseconds limit);
  /// Whether a look-up has ended since the last call.
  bool take_news();
  /// Names that were found are looked up anew from now on: a machine may have moved.
  void forget();
  /// Names that were not found are looked up anew from now on.
  void forget_failed();

 private:
  struct Shared;
  LookUp look_up_;
  std::shared_ptr<Shared> shared_;
};

}  // namespace limber
