// PresetTaker: copies chosen values of the live world into a preset. Which numbers these are is found out once for as
// long as nothing comes or goes; after that a preset is a few copies of memory. What came or went is found out without
// a look at the rest. [sim]
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/preset.h"
#include "engine/preset_plan.h"
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
  void make_ready(const Store& store) { (void)every(store); }
  /// Whether that is done.
  bool ready(const Store& store) const { return structure_ == store.structure_version() && every_; }
  /// What `choice` names, as it is now. Errors: a pattern that is none, is too much work, or reaches no property.
  Result<std::shared_ptr<const Preset>> take(const Store& store, std::string name, const PresetChoice& choice);
  /// From now on it is another store.
  void forget_store();

  /// Every property as a scene's run has left it; of the scene's own parameters their defaults.
  static std::shared_ptr<const Preset> take_script(const Store& store);

 private:
  /// `room`: its memory holds the numbers, if there is enough.
  static std::shared_ptr<const Preset> copy(const Store& store, const PresetPlan& plan, std::string name,
                                            std::vector<double> room);

  void make_room(const Store& store);
  void follow(const Store& store);
  void plan_ahead(const Store& store, std::size_t things);
  const PresetPlan& every(const Store& store);
  Result<const PresetPlan*> plan_for(const Store& store, const PresetChoice& choice);

  std::optional<PresetPlan> every_;        // of every property
  std::vector<PresetPlan> choices_;        // made of that
  std::optional<PresetPlan> before_;       // of every property, before something came or went
  std::unique_ptr<PresetPlanning> ahead_;  // of every property, on its way
  std::uint64_t structure_ = 0;            // the plans'
  int quiet_ = 0;
  std::vector<double> room_;  // for the numbers of the next one
  std::future<std::vector<double>> making_room_;
};

}  // namespace limber
