// Description: what a run of a scene says: things by name, how each was made, and a value for each of their rows, the
// one said last, else the default. Plain data, taken once after a run; two of them are compared on any thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/behavior_list.h"
#include "sim/world.h"

namespace limber {

/// A row as the run left it: said by the script (or by what was copied), or a default. Rows that were not said and hold
/// the table's own default are left out.
struct SaidRow {
  std::uint32_t row = 0;
  bool said = false;
  std::array<double, 4> values{};
};
using SaidRows = std::vector<SaidRow>;  ///< In the table's order.

/// Where a part, or a body's root, begins.
struct StartPlace {
  Pose pose;
  bool said_position = false;
  bool said_rotation = false;
};

struct ShapeDescription {
  std::string name;
  SaidRows rows;
  ShapeModel model;
  std::vector<PlacedShape> children;
};
struct PartDescription {
  std::string name;
  SaidRows rows;
  StartPlace start;
  bool is_static = false;
  std::shared_ptr<const ShapeDescription> shape;  ///< Null: a link of the body's model.
  std::size_t tree = 0;                           ///< The first part of its tree (Body::trees).
};
struct JointDescription {
  std::string name;
  SaidRows rows;
  JointSpec spec;
  std::size_t parent = 0;
  std::size_t child = 0;
  Pose start;  ///< The child's joint frame in the parent's, at the start.
};
struct MotorDescription {
  std::size_t joint = 0;
  SaidRows rows;
};
/// A pair of parts, by their places, that a script excluded from collision or included.
struct PairDescription {
  std::size_t a = 0;
  std::size_t b = 0;
  PairEdit edit = PairEdit::none;
};
/// A behaviour of a body; of a group's member only the rows count.
struct BehaviorDescription {
  std::string name;
  std::string type;
  const Table* table = nullptr;
  BehaviorSetup setup;
  bool of_group = false;
  SaidRows rows;
};
struct GroupDescription {
  std::string name;
  std::string type;
  const Table* table = nullptr;
  GroupSetup setup;
  SaidRows rows;
};
struct GearDescription {
  std::string name;
  std::string body_a, joint_a;
  std::string body_b, joint_b;
  SaidRows rows;
};
struct BodyDescription {
  std::string name;
  SaidRows rows;
  StartPlace start;
  std::shared_ptr<const BodyModel> model;
  std::vector<PartDescription> parts;
  std::vector<JointDescription> joints;
  std::vector<MotorDescription> motors;
  std::vector<PairDescription> pairs;
  std::vector<BehaviorDescription> behaviors;
};
struct Description {
  SaidRows world;
  SaidRows visuals;
  SaidRows camera;
  SaidRows look;
  std::vector<std::shared_ptr<const ShapeDescription>> shapes;
  std::vector<BodyDescription> bodies;
  std::vector<GearDescription> gears;
  std::vector<GroupDescription> groups;
  std::vector<std::string> behavior_order;  ///< BehaviorList::order()
};

/// What stands in a world, in its order, right after a run and before anything else happened to it.
Description describe(const World& world);
BodyDescription describe_body(const Body& body);

/// The rows that a description tells of, a bit a row: what may be set and is stored, but no poses.
std::uint64_t described_rows(const Table& table);
/// Of those the ones that were said.
std::uint64_t said_rows(const SaidRows& rows);

}  // namespace limber
