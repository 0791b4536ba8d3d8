// SceneSpec: capturing the objects of a world.
#include "engine/reload/scene_spec.h"

#include <algorithm>
#include <unordered_map>

#include "sim/fixtures/fixture_list.h"
#include "sim/gears/gear_list.h"
#include "sim/mocap/mocap_list.h"
#include "sim/sensors/sensor_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/state/body_trees.h"
#include "sim/tendons/tendon_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::engine {

namespace {

using Shapes = std::unordered_map<std::uint32_t, std::shared_ptr<const ShapeDescription>>;  // by slot

bool is_explicit(const Store& store, NodeId id, std::string_view property) {
  return (store.explicitly_set(id) >> store.table(id).at(property).index & 1u) != 0;
}

SpecValues spec_values_of(const Store& store, NodeId id) {
  const PropertyTable& table = store.table(id);
  const std::uint64_t explicitly_set = store.explicitly_set(id);
  const std::uint64_t described = described_mask(table);
  SpecValues result;
  for (const Property& property : table.properties()) {
    if ((described >> property.index & 1u) == 0) continue;
    const double* const values = store.values(id, property);
    const bool is_set = (explicitly_set >> property.index & 1u) != 0;
    if (!is_set && std::equal(values, values + property.width, property.initial.begin())) continue;
    SpecValue& entry = result.emplace_back(SpecValue{property.index, is_set, {}});
    std::copy_n(values, property.width, entry.values.begin());
  }
  return result;
}

std::shared_ptr<const ShapeDescription> describe_shape(const Store& store, const sim::Shape& shape) {
  return std::make_shared<const ShapeDescription>(
      ShapeDescription{shape.name(), spec_values_of(store, shape.id()), shape.model(), shape.children()});
}

StartPose start_pose_of(const Store& store, NodeId id, const Pose& pose) {
  return {pose, is_explicit(store, id, "position"), is_explicit(store, id, "rotation")};
}

BodyDescription body_of(const sim::Body& body, const Shapes& shapes) {
  const Store& store = body.store();
  BodyDescription out;
  out.name = body.name();
  out.values = spec_values_of(store, body.id());
  out.start = start_pose_of(store, body.id(), body.pose());
  out.model = body.model();
  const std::vector<std::size_t> trees = sim::tree_roots(body);
  std::unordered_map<const sim::Part*, std::size_t> part_index;
  for (const auto& part : body.parts()) {
    part_index[part.get()] = out.parts.size();
    const auto shape = shapes.find(part->shape().slot);
    out.parts.push_back({part->name(), spec_values_of(store, part->id()),
                         start_pose_of(store, part->id(), part->pose()), part->mass() == 0,
                         shape == shapes.end() ? nullptr : shape->second, trees[out.parts.size()]});
  }
  if (!out.parts.empty()) {
    // the root part and the body share one pose, which may be set through either
    out.start.position_set |= out.parts.front().start.position_set;
    out.start.rotation_set |= out.parts.front().start.rotation_set;
  }
  std::unordered_map<const sim::Joint*, std::size_t> joint_index;
  for (const auto& joint : body.joints()) {
    joint_index[joint.get()] = out.joints.size();
    const Pose from = joint->parent().pose() * joint->spec().frame_in_parent;
    const Pose to = joint->child().pose() * joint->spec().frame_in_child;
    out.joints.push_back({joint->name(), spec_values_of(store, joint->id()), joint->spec(),
                          part_index[&joint->parent()], part_index[&joint->child()], from.inverse() * to});
  }
  for (const auto& motor : body.motors()) {
    out.motors.push_back({joint_index[&motor->joint()], spec_values_of(store, motor->id())});
  }
  for (const auto& sensor : body.sensors().list()) {
    out.sensors.push_back(
        {sensor->name(), sensor->kind(), part_index[&sensor->part()], spec_values_of(store, sensor->id())});
  }
  for (const sim::PartPair& pair : body.pairs().list()) {
    if (pair.edit != sim::PairEdit::none) out.pairs.push_back({pair.a, pair.b, pair.edit});
  }
  for (const sim::Behavior* behavior : body.behaviors().list()) {
    out.behaviors.push_back({behavior->name(), behavior->type().name, behavior->type().table, behavior->setup(),
                             behavior->group() != nullptr, spec_values_of(store, behavior->id())});
  }
  return out;
}

}  // namespace

std::vector<NodeId> objects_of(const sim::Body& body) {
  std::vector<NodeId> ids{body.id()};
  const auto add = [&](const auto& list) {
    for (const auto& object : list) ids.push_back(object->id());
  };
  add(body.parts());
  add(body.joints());
  add(body.motors());
  add(body.sensors().list());
  return ids;
}

std::uint64_t described_mask(const PropertyTable& table) {
  std::uint64_t mask = 0;
  for (const Property& property : table.properties()) {
    const bool pose = &table == &sim::Part::table() && (property.name == "position" || property.name == "rotation");
    if (property.stored() && property.writable() && !pose) mask |= std::uint64_t{1} << property.index;
  }
  return mask;
}

std::uint64_t explicit_mask(const SpecValues& values) {
  std::uint64_t mask = 0;
  for (const SpecValue& value : values) mask |= std::uint64_t{value.is_set} << value.property;
  return mask;
}

BodyDescription describe_body(const sim::Body& body) {
  const sim::World& world = body.world();
  Shapes shapes;
  for (const auto& part : body.parts()) {
    if (!world.store().alive(part->shape()) || shapes.contains(part->shape().slot)) continue;
    shapes[part->shape().slot] =
        describe_shape(world.store(), *static_cast<const sim::Shape*>(world.store().object(part->shape())));
  }
  return body_of(body, shapes);
}

std::array<NodeId, kSingleNodes> single_nodes(const sim::World& world) {
  const sim::Visuals& visuals = world.visuals();
  return {world.id(), visuals.id(), visuals.camera().id(), visuals.appearance().id(), world.behaviors().clock().id()};
}

SceneSpec describe(const sim::World& world) {
  SceneSpec out;
  const std::array<NodeId, kSingleNodes> singles = single_nodes(world);
  for (std::size_t i = 0; i < kSingleNodes; i++) {
    out.singles[i] = spec_values_of(world.store(), singles[i]);
    const sim::Camera& camera = world.visuals().camera();
    if (singles[i] != camera.id() || !camera.has_framed_pose()) continue;
    std::erase_if(out.singles[i], [](const SpecValue& value) {
      return !value.is_set && (sim::Camera::pose_mask() >> value.property & 1u) != 0;
    });
  }
  Shapes shapes;
  for (const auto& shape : world.shapes().list()) {
    out.shapes.push_back(describe_shape(world.store(), *shape));
    shapes[shape->id().slot] = out.shapes.back();
  }
  out.bodies.reserve(world.bodies().size());
  for (const auto& body : world.bodies()) out.bodies.push_back(body_of(*body, shapes));
  for (const auto& gear : world.gears().list()) {
    const sim::Joint& a = gear->joint_a();
    const sim::Joint& b = gear->joint_b();
    out.gears.push_back({gear->name(), a.body().name(), a.name(), b.body().name(), b.name(),
                         spec_values_of(world.store(), gear->id())});
  }
  for (const auto& tendon : world.tendons().list()) {
    TendonDescription& description = out.tendons.emplace_back();
    description.body = tendon->body().name();
    description.name = tendon->name();
    for (const sim::Tendon::Point& point : tendon->points())
      description.points.push_back({point.part->body().name(), point.part->name(), point.position});
    description.values = spec_values_of(world.store(), tendon->id());
  }
  for (const auto& fixture : world.visuals().fixtures().list())
    out.fixtures.push_back(
        {fixture->name(), fixture->shared_profile(), fixture->targets(), spec_values_of(world.store(), fixture->id())});
  for (const auto& source : world.sensing().mocap().list()) {
    MocapDescription& description = out.mocap.emplace_back(MocapDescription{source->name(), source->setup(), {}, {}});
    for (const auto& joint : source->joints()) description.joints.push_back(joint->name());
    description.values = spec_values_of(world.store(), source->id());
  }
  for (const sim::BehaviorGroup* group : world.behaviors().groups()) {
    out.groups.push_back({group->name(), group->type().name, group->type().group_table, group->setup(),
                          spec_values_of(world.store(), group->id())});
  }
  for (const auto& route : world.behaviors().routes().list())
    out.routes.push_back({route->name(), route->from(), route->to(), spec_values_of(world.store(), route->id())});
  out.behavior_order = world.behaviors().order().keys();
  return out;
}

}  // namespace limber::engine
