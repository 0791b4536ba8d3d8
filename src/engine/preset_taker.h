// PresetTaker: copies chosen values of the live world into a preset. Which numbers these are is found out once for as
// long as nothing comes or goes; after that a preset is a few copies of memory. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/preset.h"
#include "params/store.h"

namespace limber {

class PresetTaker {
 public:
  /// What `choice` names, as it is now. Errors: a pattern that is none, is too much work, or reaches no property.
  Result<std::shared_ptr<const Preset>> take(const Store& store, std::string name, const PresetChoice& choice);
  /// From now on it is another store.
  void forget_store() { plans_.clear(); }

  /// Every property as a scene's run has left it; of the scene's own parameters their defaults.
  static std::shared_ptr<const Preset> take_script(const Store& store);

 private:
  struct Piece {  // numbers that stand side by side in the store and in the preset
    std::uint32_t from = 0;
    std::uint32_t count = 0;
    bool live = false;
  };
  struct Plan {
    PresetChoice choice;
    std::uint64_t structure = 0;
    std::shared_ptr<const PresetShape> shape;
    std::vector<Piece> pieces;
  };
  class Planning;

  static std::shared_ptr<const Preset> copy(const Store& store, const Plan& plan, std::string name);

  std::vector<Plan> plans_;
};

}  // namespace limber
