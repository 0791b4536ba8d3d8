// SceneDiff: the differences between the specs of two runs of a scene. The rule: values that the script has changed are
// applied; values that it sets as before keep their overrides; values that it no longer sets return to their default.
// [any]
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/reload/scene_spec.h"

namespace limber::engine {

/// A body that is added or differs between the two specs. Sets of properties are bit masks.
struct BodyDiff {
  std::size_t new_index = 0;             ///< Index in the new spec.
  std::optional<std::size_t> old_index;  ///< Index in the old spec.
  bool rebuild = false;                  ///< Its construction differs, so it must be rebuilt.
  std::vector<std::uint64_t> changed;    ///< Properties to set of each of its objects in the new spec (objects_of()).
  std::vector<PairDescription> pairs;    ///< Pairs to set; PairEdit::none restores the default.
  bool position_changed = false;         ///< The root must move to its new start position.
  bool rotation_changed = false;         ///< The root must turn to its new start rotation.
  std::vector<std::size_t> trees_with_root;  ///< First parts of other trees that move along with the root.
  std::vector<std::size_t> trees_placed;     ///< First parts of other trees that move to their own new start pose.
  bool start_changed = false;                ///< Start poses differ.
  std::vector<bool> joints_to_reset;         ///< If the body is rebuilt: the joints with another start pose.

  bool empty() const;
};

struct ShapeDiff {
  std::size_t new_index = 0;
  bool geometry_changed = false;
  std::uint64_t changed = 0;
};

/// Changes of a behavior or a group.
struct BehaviorDiff {
  bool in_old_spec = false;   ///< It is in the old spec.
  bool rebuild = false;       ///< Its type or targets differ, so it must be rebuilt.
  std::uint64_t changed = 0;  ///< Properties to set, as bits of the new table.

  bool empty() const { return in_old_spec && !rebuild && changed == 0; }
};

/// Changes of a gear, tendon, fixture, source of motion capture or route.
struct ObjectDiff {
  bool in_old_spec = false;   ///< It is in the old spec.
  bool same_build = true;     ///< The parts that can't be set are the same: joints, points, setup, addresses.
  std::uint64_t changed = 0;  ///< Properties to set.

  bool empty() const { return in_old_spec && same_build && changed == 0; }
};

template <class Key>
struct ObjectDiffs {
  std::vector<ObjectDiff> list;  ///< For each object of the new spec.
  std::vector<Key> removed;

  bool empty() const {
    return removed.empty() && std::ranges::all_of(list, [](const ObjectDiff& each) { return each.empty(); });
  }
};

struct SceneDiff {
  std::array<std::uint64_t, kSingleNodes> singles{};          ///< Properties of the single_nodes() to set.
  std::vector<std::optional<std::size_t>> old_shape_indices;  ///< For each new shape its index in the old spec.
  std::vector<std::optional<std::size_t>> old_body_indices;   ///< For each new body its index in the old spec.
  std::vector<ShapeDiff> shapes;                              ///< Changed shapes, without added ones.
  std::vector<BodyDiff> bodies;                               ///< Changed bodies, without added ones.
  std::vector<std::size_t> removed_shapes;                    ///< Removed shapes, by index in the old spec.
  std::vector<std::size_t> removed_bodies;                    ///< Removed bodies, by index in the old spec.
  std::vector<std::vector<BehaviorDiff>> behaviors;           ///< For each new body, each of its behaviors.
  std::vector<BehaviorDiff> groups;                           ///< For each new group.
  /// Removed behaviors, by body (index in the new spec) and name.
  std::vector<std::pair<std::size_t, std::string>> removed_behaviors;
  std::vector<std::string> removed_groups;  ///< Removed groups.
  ObjectDiffs<std::string> gears;
  ObjectDiffs<std::pair<std::string, std::string>> tendons;  ///< By the names of their bodies and their own.
  ObjectDiffs<std::string> fixtures;
  ObjectDiffs<std::string> mocap;
  ObjectDiffs<std::string> routes;
  bool order_changed = false;  ///< The order of the behaviors differs.

  bool empty() const;
};

SceneDiff compare(const SceneSpec& before, const SceneSpec& now);
/// Compares an unmanaged body (one that was made in a callback, not by the spec) with its spec `now`. Only explicitly
/// set values are applied; the others stay. `existing`: the state of the body, captured as a spec.
BodyDiff compare_unmanaged(const BodyDescription& existing, const BodyDescription& now);

/// Returns a bit mask of the properties that differ in value or in being explicitly set.
std::uint64_t changed_mask(const SpecValues& before, const SpecValues& now);

}  // namespace limber::engine
