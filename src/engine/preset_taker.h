// PresetTaker: copies chosen values of the live world into a preset. Which numbers these are is found out once for as
// long as nothing comes or goes; after that a preset is a few copies of memory. What came or went is found out without
// a look at the rest. [sim]
#pragma once

#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "engine/preset.h"
#include "params/store.h"

namespace limber {

class PresetTaker {
 public:
  /// Things that prepare() looks at, at a time.
  static constexpr std::size_t kSlice = 500;
  /// For so many calls of prepare() nothing has come or gone before it begins; but much that came is looked at at once.
  static constexpr int kQuiet = 30;

  /// Numbers: for fewer no room is made ahead.
  static constexpr std::size_t kRoomWorth = std::size_t{1} << 15u;

  PresetTaker();
  ~PresetTaker();
  PresetTaker(const PresetTaker&) = delete;
  PresetTaker& operator=(const PresetTaker&) = delete;

  /// A little of the way to a preset of every property, so that the first one in a large world costs no more than the
  /// next: once a tick.
  void prepare(const Store& store);
  /// All of the way, where there is time.
  void make_ready(const Store& store) { (void)plan_for(store, {}); }
  /// Whether that is done.
  bool ready(const Store& store) const { return structure_ == store.structure_version() && known({}) != nullptr; }
  /// What `choice` names, as it is now. Errors: a pattern that is none, is too much work, or reaches no property.
  Result<std::shared_ptr<const Preset>> take(const Store& store, std::string name, const PresetChoice& choice);
  /// From now on it is another store.
  void forget_store();

  /// Every property as a scene's run has left it; of the scene's own parameters their defaults.
  static std::shared_ptr<const Preset> take_script(const Store& store);

 private:
  struct Piece {  // numbers that stand side by side in the store and in the preset
    std::uint32_t from = 0;
    std::uint32_t count = 0;
    bool live = false;
    std::uint32_t at = 0;  // in the preset
  };
  // some rows of a class, as a thing that has them gives them
  struct Cut {
    std::uint32_t rows = 0;
    std::vector<Piece> pieces;  // from where the thing's own numbers begin
  };
  using Cuts = std::map<std::pair<const Table*, std::uint64_t>, Cut>;
  struct Plan {
    PresetChoice choice;
    std::shared_ptr<const PresetShape> shape;
    std::vector<Piece> pieces;
    std::uint64_t structure = 0;       // the store's
    std::vector<std::uint32_t> slots;  // of the shape's things
    Cuts cuts;                         // the shape's classes
  };
  class Planning;

  /// `room`: its memory holds the numbers, if there is enough.
  static std::shared_ptr<const Preset> copy(const Store& store, const Plan& plan, std::string name,
                                            std::vector<double> room);

  void make_room(const Store& store);
  void follow(const Store& store);
  const Plan* known(const PresetChoice& choice) const;
  const Plan& keep(Plan plan);
  Result<const Plan*> plan_for(const Store& store, const PresetChoice& choice);
  const Plan* before(const PresetChoice& choice) const;

  std::vector<Plan> plans_;          // those that hold
  std::optional<Plan> before_;       // of every property, before something came or went
  std::unique_ptr<Planning> ahead_;  // of every property, on its way
  std::uint64_t structure_ = 0;      // the plans'
  int quiet_ = 0;
  std::vector<double> room_;  // for the numbers of the next one
  std::future<std::vector<double>> making_room_;
};

}  // namespace limber
