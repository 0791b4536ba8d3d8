// Subscription: produces the lines for a subscribed console: messages sent and received, or changed values.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/output/engine_link.h"
#include "net/console/protocol.h"

namespace limber::console {

/// [console]
class Subscription {
 public:
  virtual ~Subscription() = default;

  /// Calls send(line) for each new line, and drop(count) for lines that were overwritten before they could be sent.
  virtual void poll(const std::function<void(std::string)>& send, const std::function<void(std::uint64_t)>& drop) = 0;
};

/// Creates the subscription for a request; the error describes the mistake in its pattern. `link` outlives it.
Result<std::unique_ptr<Subscription>> make_subscription(engine::EngineLink& link, const ConsoleRequest& request);

}  // namespace limber::console
