// ConsoleParams: records the scene parameters (`params`) that a console evaluation sets, so that they become overrides,
// like parameters set by messages. [sim]
#pragma once

#include <cstdint>

#include "engine/edits/overrides.h"
#include "properties/store.h"

namespace limber::engine {

class ConsoleParams {
 public:
  /// During its lifetime, records writes to the node `params`. The previous listener of the store is still called.
  ConsoleParams(Store& store, NodeId params);
  ~ConsoleParams();
  ConsoleParams(const ConsoleParams&) = delete;
  ConsoleParams& operator=(const ConsoleParams&) = delete;

  /// Adds the current values of the recorded parameters to the overrides.
  void add_to(Overrides& overrides) const;

 private:
  void on_write(NodeId id, const Property& property, bool over_time, const double* old_values);

  Store& store_;
  NodeId params_;
  Store::Listener previous_;
  std::uint64_t written_ = 0;  // bit mask of the parameters that were set
};

}  // namespace limber::engine
