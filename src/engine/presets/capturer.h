// PresetCapturer: captures presets from the live world. The list of values to copy (PresetPlan) is cached until nodes
// are added or removed, so that a capture is a few memory copies. [sim]
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"
#include "properties/store.h"

namespace limber::engine {

class PresetPlanner;

/// The values to copy from the store into a preset.
struct PresetPlan {
  struct CopyRange {  // a range of values that is contiguous in the store and in the preset
    std::uint32_t source = 0;
    std::uint32_t count = 0;
    bool transient = false;
  };
  struct Node {
    NodeId id;
    const PropertyTable* table = nullptr;
    std::uint64_t properties = 0;  // bit mask
  };
  PresetSelection selection;
  std::shared_ptr<const PresetSchema> schema;
  std::vector<CopyRange> ranges;  // in the order of the preset
  std::vector<Node> nodes;        // those with values
};

class PresetCapturer {
 public:
  /// Number of nodes that prepare() visits per call.
  static constexpr std::size_t kNodesPerCall = 500;
  /// Number of calls of prepare() without structural changes before it starts planning. After large changes it plans at
  /// once.
  static constexpr int kSettleCalls = 30;

  /// Smallest number of values for which a buffer is allocated ahead.
  static constexpr std::size_t kMinBufferValues = std::size_t{1} << 15u;

  PresetCapturer();
  ~PresetCapturer();
  PresetCapturer(const PresetCapturer&) = delete;
  PresetCapturer& operator=(const PresetCapturer&) = delete;

  /// Does a slice of the planning for a preset of all properties, so that the first capture in a large world costs no
  /// more than later ones. Call once per tick.
  void prepare(const Store& store);
  /// Completes the planning at once; for use when no tick waits.
  void finish_planning(const Store& store) { (void)plan_everything(store); }
  /// True if the planning is complete.
  bool ready(const Store& store) const { return structure_version_ == store.structure_version() && everything_; }
  /// Captures the selected values. Error: a pattern is invalid, costs too much work or matches no property.
  Result<std::shared_ptr<const Preset>> capture(const Store& store, std::string name, const PresetSelection& selection);
  /// Discards the plans, because another store will be passed.
  void forget_store();

  /// Captures all properties after a run of the scene as the preset "script". The scene's parameters get their
  /// defaults.
  static std::shared_ptr<const Preset> capture_script(const Store& store);

 private:
  void allocate_buffer(const Store& store);
  void discard_outdated(const Store& store);
  void advance_plan(const Store& store, std::size_t nodes);
  const PresetPlan& plan_everything(const Store& store);
  Result<const PresetPlan*> plan_for(const Store& store, const PresetSelection& selection);

  std::optional<PresetPlan> everything_;    // for all properties
  std::vector<PresetPlan> selections_;      // for recent selections
  std::unique_ptr<PresetPlanner> planner_;  // builds the next plan for all properties
  std::uint64_t structure_version_ = 0;     // structure version of the plans
  int settled_calls_ = 0;
  std::vector<double> buffer_;  // buffer for the next preset
  std::future<std::vector<double>> next_buffer_;
};

}  // namespace limber::engine
