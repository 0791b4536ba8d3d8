// Draft: a scene that is run beside the show, in a store and a world of its own, and what it says otherwise than the
// last good run. Nothing live is touched, so it may take its time. [any]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/description.h"
#include "engine/difference.h"
#include "engine/preset.h"
#include "script/scene.h"
#include "script/sources.h"

namespace limber {

/// What a draft is made from; copied from the show between two ticks.
struct DraftOrder {
  std::string file;
  SceneOptions options;
  RunInputs inputs;
  std::shared_ptr<const Description> before;  ///< Of the last good run.
};

class Draft {
 public:
  /// Runs the file. `host` hears what the top level prints, on this thread.
  Draft(DraftOrder order, ScriptHost& host);
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  const DraftOrder& order() const { return order_; }
  /// Whether the run was good; if not, `error` and its place say why, and nothing below counts.
  const Result<void>& ran() const { return ran_; }
  const ScriptPlace& fault() const { return scene_->fault(); }

  const World& world() const { return world_; }
  const std::shared_ptr<const Description>& description() const { return description_; }
  const Difference& difference() const { return difference_; }
  std::vector<SourceFile> files() const;
  /// Every property as the run describes it.
  const std::shared_ptr<const Preset>& script() const { return script_; }

  /// The scene that becomes the show; what is left in its place goes with the draft.
  std::unique_ptr<Scene>& scene() { return scene_; }
  /// The live id of one of the draft's things. [sim]
  NodeId live_id(NodeId id, const World& live, const std::vector<NodeId>& shapes,
                 const std::vector<NodeId>& bodies) const;

 private:
  enum class Kind : std::uint8_t {
    none,
    world,
    visuals,
    camera,
    look,
    shape,
    body,
    part,
    joint,
    motor,
    gear,
    behavior,
    group
  };
  struct Spot {  // what a slot of the store is
    Kind kind = Kind::none;
    std::uint32_t owner = 0;  // number of the body or shape
    std::uint32_t number = 0;
  };
  void find_spots();

  DraftOrder order_;
  Store store_;
  World world_{store_};
  std::vector<Spot> spots_;
  std::unique_ptr<Scene> scene_;  // before the world goes
  Result<void> ran_;
  std::shared_ptr<const Description> description_;
  Difference difference_;
  std::shared_ptr<const Preset> script_;
};

}  // namespace limber
