// Watcher: what a console that watches is told: messages as they come and go, or values as they change. [the server's
// thread]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "console/protocol.h"
#include "engine/link.h"

namespace limber {

class Watcher {
 public:
  virtual ~Watcher() = default;

  /// Calls say(line) for each that is new, and miss(count) for those that were forgotten before they could be told.
  virtual void tell(const std::function<void(std::string)>& say, const std::function<void(std::uint64_t)>& miss) = 0;
};

/// For a request to watch; the error says what is wrong with its pattern. `link` outlives it.
Result<std::unique_ptr<Watcher>> make_watcher(EngineLink& link, const ConsoleRequest& request);

}  // namespace limber
