// ParamsNode: a scene's own parameters (`params { … }`) as the node /scene of the store. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "properties/store.h"
#include "script/scene/run_inputs.h"

namespace limber::script {

class ParamsNode {
 public:
  /// Adds /scene with these properties (at most 64, with names that differ by the naming rule).
  ParamsNode(Store& store, std::vector<Property> properties);
  ~ParamsNode();
  ParamsNode(const ParamsNode&) = delete;
  ParamsNode& operator=(const ParamsNode&) = delete;

  NodeId id() const { return id_; }
  const PropertyTable& table() const { return store_.table(id_); }

  /// Returns the properties with their current values.
  std::vector<LiveParam> values() const;
  /// Carries over the values of the previous run's parameters, clamped to the new ranges and choices. A parameter
  /// with an edited default or type starts at its default. Returns a bit mask of these, by property index.
  std::uint64_t carry_over(std::span<const LiveParam> previous);

 private:
  Store& store_;
  NodeId id_;
};

/// The parameters of a run.
struct SceneParams {
  std::unique_ptr<ParamsNode> node;
  std::span<const LiveParam> previous;  ///< During a detached run: the parameters of the live scene.
  NodeId live;                          ///< Of an earlier run, which has no parameters: the live run's node, or null.
  std::uint64_t rerun_properties = 0;   ///< Bit mask of the parameters with `rerun`, by property index.
  NodeId id() const { return node == nullptr ? NodeId{} : node->id(); }
};

}  // namespace limber::script
