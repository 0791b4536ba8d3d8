// PresetPlan: the list of value ranges to copy from the store into a preset. The plan for all properties is built by a
// traversal of the store, optionally in slices; the plan for a selection is derived from it without another traversal.
// [sim]
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"
#include "properties/store.h"

namespace limber {

struct PresetPlan {
  struct CopyRange {  // a range of values that is contiguous in the store and in the preset
    std::uint32_t source = 0;
    std::uint32_t count = 0;
    bool transient = false;
    std::uint32_t destination = 0;  // offset in the preset
  };
  PresetSelection selection;
  std::shared_ptr<const PresetSchema> schema;
  std::vector<CopyRange> ranges;

  /// Returns the plan for a selection. `everything`: plan for all properties, which must be up to date with the
  /// structure of the store. Error: a pattern is invalid, costs too much work or matches no property.
  static Result<PresetPlan> for_selection(const Store& store, const PresetPlan& everything,
                                          const PresetSelection& selection);

 private:
  friend class PresetPlanner;
  // a subset of the properties of a node type, and the ranges of values that a node of it contributes
  struct NodePlan {
    const PropertyTable* table = nullptr;
    std::uint64_t properties = 0;
    std::uint32_t layout = 0;       // index of the layout in the schema
    std::vector<CopyRange> ranges;  // relative to the first value of the node
  };
  class NodeView;
  class Selector;

  const NodePlan& node_plan(PresetSchema& schema, const PropertyTable& table, std::uint64_t properties);
  void append_node(const NodePlan& node_plan, const NodeSlot& slot, std::uint32_t at);
  void append(const CopyRange& range) { append(range, ranges); }
  static void append(const CopyRange& range, std::vector<CopyRange>& ranges);

  std::uint64_t structure_version_ = 0;  // structure version of the store
  std::vector<NodeId> node_ids_;         // nodes of the store, for each node of the schema
  std::map<std::pair<const PropertyTable*, std::uint64_t>, NodePlan> node_plans_;  // one for each layout of the schema
  const NodePlan* last_node_plan_ = nullptr;  // consecutive nodes are usually alike
};

/// Builds the plan for all properties by a traversal of the store, which can be spread over several ticks.
class PresetPlanner {
 public:
  /// `previous`: an older plan for all properties, or null. Unchanged subtrees are copied from it. It must outlive
  /// this.
  PresetPlanner(const Store& store, const PresetPlan* previous);
  /// Visits up to `count` nodes; true once all nodes were visited.
  bool advance(std::size_t count);
  PresetPlan finish();
  static PresetPlan make(const Store& store, const PresetPlan* previous);

 private:
  // the stored properties of a node type
  struct NodeType {
    std::uint64_t properties = 0;
    // properties that are read-only on some nodes, such as the mass of a static part
    std::vector<const Property*> conditional;
  };
  const NodeType& node_type(const PropertyTable& table);
  void add(NodeId id);
  void copy_unchanged(NodeId id);
  void copy_ranges(std::uint32_t from, std::uint32_t to, std::uint32_t count);
  std::uint32_t node_index(NodeId id);

  const Store& store_;
  const PresetPlan* previous_;
  std::vector<std::uint32_t> previous_indices_;  // by slot
  PresetPlan plan_;
  std::shared_ptr<PresetSchema> schema_ = std::make_shared<PresetSchema>();
  std::unordered_map<const PropertyTable*, NodeType> node_types_;
  std::pair<const PropertyTable*, const NodeType*> last_node_type_{};  // consecutive nodes are usually alike
  std::vector<std::uint32_t> node_indices_;                            // by slot
  std::vector<NodeId> stack_;                                          // stack of nodes to be visited
};

}  // namespace limber
