// Difference: what one description says otherwise than the one before. The one rule: what is said otherwise is applied;
// what is said as before stays as the performer's hand left it; what is no longer said returns to its default. [any]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/description.h"

namespace limber {

/// A body that is new, or that the two descriptions tell differently. Rows stand as a bit a row.
struct BodyDifference {
  std::size_t now = 0;                ///< In the description now.
  std::optional<std::size_t> before;  ///< In the one before.
  bool anew = false;                  ///< Its making is another one.
  std::uint64_t rows = 0;             ///< To be set, of the body's node.
  std::vector<std::uint64_t> parts;   ///< To be set, for each of its parts, joints, motors now.
  std::vector<std::uint64_t> joints;
  std::vector<std::uint64_t> motors;
  std::vector<PairDescription> pairs;  ///< To be set; none: its default.
  bool position = false;               ///< The root is to go where it is said now.
  bool rotation = false;
  std::vector<std::size_t> trees_along;   ///< First parts of other trees that go with the root.
  std::vector<std::size_t> trees_placed;  ///< And of those that go where they are said now.
  bool start = false;                     ///< Start poses are others.
  std::vector<bool> joints_start_anew;    ///< Joints whose start is said otherwise, when the body is made anew.

  bool empty() const;
};

struct ShapeDifference {
  std::size_t now = 0;
  bool geometry = false;
  std::uint64_t rows = 0;
};

/// What a behaviour, or a group, is to become.
struct BehaviorDifference {
  bool described = false;  ///< The description before had it.
  bool anew = false;       ///< Another type, or it acts on others.
  std::uint64_t rows = 0;  ///< To be set, by the table that it has now.
};

/// What a gear is to become. A gear between other joints is made again.
struct GearDifference {
  bool described = false;   ///< The description before had it.
  bool same_joints = true;  ///< Between the same joints.
  std::uint64_t rows = 0;   ///< To be set.
};

struct Difference {
  std::uint64_t world = 0;                                ///< Rows of the world to be set.
  std::uint64_t visuals = 0;                              ///< Of the picture's background,
  std::uint64_t camera = 0;                               ///< of its camera,
  std::uint64_t look = 0;                                 ///< of its look.
  std::vector<std::optional<std::size_t>> shapes_before;  ///< For each shape now, which one it was.
  std::vector<std::optional<std::size_t>> bodies_before;
  std::vector<ShapeDifference> shapes;  ///< Those that were there and are told differently.
  std::vector<BodyDifference> bodies;   ///< The same, of bodies.
  std::vector<std::size_t> gone_shapes;
  std::vector<std::size_t> gone_bodies;
  std::vector<std::vector<BehaviorDifference>> behaviors;  ///< Of each body now, each of its behaviours.
  std::vector<BehaviorDifference> groups;                  ///< Each group now.
  /// Behaviours that are no longer described, by body (a number of the description now) and name.
  std::vector<std::pair<std::size_t, std::string>> gone_behaviors;
  std::vector<std::string> gone_groups;
  std::vector<GearDifference> gears;  ///< Each gear now.
  std::vector<std::string> gone_gears;
  bool other_order = false;  ///< Behaviours act in another order.

  bool empty() const;
};

Difference compare(const Description& before, const Description& now);
/// What `now` says of a body that stands there without having been described, as `stands`: what is said counts, the
/// rest stays.
BodyDifference compare_stranger(const BodyDescription& stands, const BodyDescription& now);

/// Rows that differ in value or in whether they were said.
std::uint64_t changed_rows(const SaidRows& before, const SaidRows& now);

}  // namespace limber
