// CounterNode: the node /osc, which publishes counters of messages received, sent and lost as readouts. [sim]
#pragma once

#include "engine/commands/command.h"
#include "properties/store.h"

namespace limber::engine {

class CounterNode {
 public:
  static const PropertyTable& table();

  CounterNode(Store& store, const Counters& counters);
  /// Copies the counters to the readouts.
  void publish();

 private:
  Store& store_;
  const Counters& counters_;
  NodeId id_;
};

}  // namespace limber::engine
