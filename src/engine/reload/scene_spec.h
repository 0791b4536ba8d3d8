// SceneSpec: plain data that describes the result of a scene's run: all objects by name, their construction, and the
// value of each property: the one set last, else the default. Captured once after a run; can be compared on any thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/behavior/behavior_list.h"
#include "sim/fixtures/fixture.h"
#include "sim/mocap/mocap_setup.h"
#include "sim/sensors/sensor.h"
#include "sim/world/joint.h"
#include "sim/world/world.h"

namespace limber::engine {

/// A property after the run: set by the script (or copied from another object), or a default of the object. Properties
/// that were not set and have the table's default are omitted.
struct SpecValue {
  std::uint32_t property = 0;
  bool is_set = false;
  std::array<double, 4> values{};
};
using SpecValues = std::vector<SpecValue>;  ///< In the table's order.

/// Start pose of a part or of a body's root.
struct StartPose {
  Pose pose;
  bool position_set = false;
  bool rotation_set = false;
};

struct ShapeDescription {
  std::string name;
  SpecValues values;
  model::ShapeModel model;
  std::vector<model::PlacedShape> children;
};
struct PartDescription {
  std::string name;
  SpecValues values;
  StartPose start;
  bool is_static = false;
  std::shared_ptr<const ShapeDescription> shape;  ///< Null: a link of the body's model.
  std::size_t tree = 0;                           ///< Index of the first part of its tree (Body::trees).
};
struct JointDescription {
  std::string name;
  SpecValues values;
  sim::JointSpec spec;
  std::size_t parent = 0;  ///< Index of the part.
  std::size_t child = 0;   ///< Index of the part.
  Pose start;              ///< The child's joint frame in the parent's, at the start.
};
struct MotorDescription {
  std::size_t joint = 0;  ///< Index of the joint.
  SpecValues values;
};
struct SensorDescription {
  std::string name;
  sim::SensorKind kind{};
  std::size_t part = 0;  ///< Index of the part.
  SpecValues values;
};
/// A pair of parts, by index, that a script excluded from or included in collision.
struct PairDescription {
  std::size_t a = 0;
  std::size_t b = 0;
  sim::PairEdit edit = sim::PairEdit::none;
};
/// A behavior of a body. For members of a group only `values` is used.
struct BehaviorDescription {
  std::string name;
  std::string type;
  const PropertyTable* table = nullptr;
  sim::BehaviorSetup setup;
  bool of_group = false;  ///< It is a member of a group.
  SpecValues values;
};
struct GroupDescription {
  std::string name;
  std::string type;
  const PropertyTable* table = nullptr;
  sim::GroupSetup setup;
  SpecValues values;
};
struct GearDescription {
  std::string name;
  std::string body_a, joint_a;
  std::string body_b, joint_b;
  SpecValues values;
};
struct RouteDescription {
  std::string name;
  std::string from, to;
  SpecValues values;
};
struct TendonDescription {
  struct Point {
    std::string body, part;
    Vec3 position{0};
    bool operator==(const Point&) const = default;
  };
  std::string body;  ///< Its owner.
  std::string name;
  std::vector<Point> points;
  SpecValues values;
};
struct FixtureDescription {
  std::string name;
  std::shared_ptr<const sim::FixtureProfile> profile;
  std::vector<sim::FixtureTarget> targets;
  SpecValues values;
};

struct MocapDescription {
  std::string name;
  std::shared_ptr<const sim::MocapSetup> setup;
  std::vector<std::string> joints;
  SpecValues values;
};
struct BodyDescription {
  std::string name;
  SpecValues values;
  StartPose start;
  std::shared_ptr<const model::BodyModel> model;
  std::vector<PartDescription> parts;
  std::vector<JointDescription> joints;
  std::vector<MotorDescription> motors;
  std::vector<SensorDescription> sensors;
  std::vector<PairDescription> pairs;
  std::vector<BehaviorDescription> behaviors;
};

/// The nodes with settings that each world has once: the world, background, camera, appearance, clock.
inline constexpr std::size_t kSingleNodes = 5;
inline constexpr std::size_t kWorldNode = 0;  ///< The world's index among them.
std::array<NodeId, kSingleNodes> single_nodes(const sim::World& world);

struct SceneSpec {
  std::array<SpecValues, kSingleNodes> singles;  ///< Of single_nodes().
  std::vector<std::shared_ptr<const ShapeDescription>> shapes;
  std::vector<BodyDescription> bodies;
  std::vector<GearDescription> gears;
  std::vector<TendonDescription> tendons;
  std::vector<FixtureDescription> fixtures;
  std::vector<MocapDescription> mocap;
  std::vector<RouteDescription> routes;
  std::vector<GroupDescription> groups;
  std::vector<std::string> behavior_order;  ///< BehaviorOrder::keys()
};

/// Captures the objects of a world in their order. Call it right after a run, before anything else changes the world.
SceneSpec describe(const sim::World& world);
BodyDescription describe_body(const sim::Body& body);

/// Returns the ids of a body and its parts, joints, motors and sensors, in this order.
std::vector<NodeId> objects_of(const sim::Body& body);

/// Returns a bit mask of the properties that a description contains: stored and writable ones, except poses of parts.
std::uint64_t described_mask(const PropertyTable& table);
/// Returns a bit mask of the properties that were explicitly set.
std::uint64_t explicit_mask(const SpecValues& values);

}  // namespace limber::engine
