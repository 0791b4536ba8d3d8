// ConsoleParams: parameters of the scene (`params`) that a console's text sets are the performer's, as those set by
// messages are: a reset keeps them. [sim]
#pragma once

#include <cstdint>

#include "engine/hand.h"
#include "params/store.h"

namespace limber {

class ConsoleParams {
 public:
  /// While it lives, what is set at the node is noted; who listens to the store hears it still.
  ConsoleParams(Store& store, NodeId params);
  ~ConsoleParams();
  ConsoleParams(const ConsoleParams&) = delete;
  ConsoleParams& operator=(const ConsoleParams&) = delete;

  /// The values that were set, as messages that the hand remembers.
  void remember(PerformerHand& hand) const;

 private:
  void heard(NodeId id, const Row& row, bool later, const double* before);

  Store& store_;
  NodeId params_;
  Store::Listener outer_;
  std::uint64_t rows_ = 0;  // set, a bit a row
};

}  // namespace limber
