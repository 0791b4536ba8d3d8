// PresetNode: publishes the presets in the property tree, at /preset. [sim]
#pragma once

#include <span>
#include <string_view>

#include "engine/presets/presets.h"

namespace limber::engine {

class PresetNode {
 public:
  static const PropertyTable& table();

  PresetNode(sim::World& world, Presets& presets);
  /// Publishes `count`, `progress` and `saved`.
  void publish();

 private:
  std::string_view read_names() const { return presets_.names(); }
  Result<void> act_recall(std::span<const double> args);
  Result<void> act_stop(std::span<const double> args);

  sim::World& world_;
  Presets& presets_;
  NodeId id_;
};

}  // namespace limber::engine
