// CounterNode: the node /osc, which publishes counters of messages received, sent and lost, and the targets, as
// readouts. [sim]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/commands/command.h"
#include "engine/output/osc_status.h"
#include "properties/store.h"

namespace limber::engine {

class CounterNode {
 public:
  static const PropertyTable& table();

  CounterNode(Store& store, const Counters& counters, const OscStatus& status);
  /// Copies the counters to the readouts.
  void publish();

 private:
  std::string_view read_targets() const;

  Store& store_;
  const Counters& counters_;
  const OscStatus& status_;
  mutable std::uint64_t version_ = 0;  // of the text, which is copied when it is read: in value snapshots only
  mutable std::string targets_;
  NodeId id_;
};

}  // namespace limber::engine
