// CueNode: publishes the cues in the property tree, at /cue, and accepts requests. [sim]
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "engine/cues/cue_player.h"
#include "sim/world/world.h"

namespace limber::engine {

class CueNode {
 public:
  static const PropertyTable& table();

  CueNode(sim::World& world, const CuePlayer& cues);
  /// Publishes the readouts.
  void publish();
  /// Returns the latest request since the last call, if there was one.
  std::optional<CueRequest> consume_request() { return std::exchange(request_, std::nullopt); }

 private:
  std::string_view read_names() const { return cues_.names(); }
  std::string_view read_fields() const { return cues_.fields(); }
  std::string_view read_name() const { return cues_.state().name; }
  Result<void> act_go(std::span<const double> args);
  Result<void> act_back(std::span<const double> args);
  Result<void> act_pause(std::span<const double> args);
  Result<void> act_jump(std::span<const double> args);

  sim::World& world_;
  const CuePlayer& cues_;
  NodeId id_;
  std::optional<CueRequest> request_;
};

}  // namespace limber::engine
