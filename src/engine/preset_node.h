// PresetNode: what the tree tells of presets, at /preset. [sim]
#pragma once

#include <span>
#include <string_view>

#include "engine/presets.h"

namespace limber {

class PresetNode {
 public:
  static const Table& table();

  PresetNode(World& world, Presets& presets);
  /// Tells `count` and `progress`.
  void tell();

 private:
  std::string_view say_names() const { return presets_.names(); }
  Result<void> act_recall(std::span<const double> args);
  Result<void> act_stop(std::span<const double> args);

  World& world_;
  Presets& presets_;
  NodeId id_;
};

}  // namespace limber
