// Taking a description from a world.
#include "engine/description.h"

#include <algorithm>
#include <unordered_map>

namespace limber {

namespace {

using Shapes = std::unordered_map<std::uint32_t, std::shared_ptr<const ShapeDescription>>;  // by slot

bool says(const Store& store, NodeId id, std::string_view row) {
  return (store.said(id) >> store.table(id).at(row).index & 1u) != 0;
}

SaidRows rows_of(const Store& store, NodeId id) {
  const Table& table = store.table(id);
  const std::uint64_t said = store.said(id);
  const std::uint64_t described = described_rows(table);
  SaidRows rows;
  for (const Row& row : table.rows()) {
    if ((described >> row.index & 1u) == 0) continue;
    const double* const values = store.values(id, row);
    const bool is_said = (said >> row.index & 1u) != 0;
    if (!is_said && std::equal(values, values + row.width, row.initial.begin())) continue;
    SaidRow& entry = rows.emplace_back(SaidRow{row.index, is_said, {}});
    std::copy_n(values, row.width, entry.values.begin());
  }
  return rows;
}

std::shared_ptr<const ShapeDescription> describe_shape(const Store& store, const Shape& shape) {
  return std::make_shared<const ShapeDescription>(
      ShapeDescription{shape.name(), rows_of(store, shape.id()), shape.model(), shape.children()});
}

StartPlace place_of(const Store& store, NodeId id, const Pose& pose) {
  return {pose, says(store, id, "position"), says(store, id, "rotation")};
}

BodyDescription body_of(const Body& body, const Shapes& shapes) {
  const Store& store = body.store();
  BodyDescription out;
  out.name = body.name();
  out.rows = rows_of(store, body.id());
  out.start = place_of(store, body.id(), body.pose());
  out.model = body.model();
  const std::vector<std::size_t> trees = body.trees();
  std::unordered_map<const Part*, std::size_t> number;
  for (const auto& part : body.parts()) {
    number[part.get()] = out.parts.size();
    const auto shape = shapes.find(part->shape().slot);
    out.parts.push_back({part->name(), rows_of(store, part->id()), place_of(store, part->id(), part->pose()),
                         part->is_static(), shape == shapes.end() ? nullptr : shape->second, trees[out.parts.size()]});
  }
  if (!out.parts.empty()) {
    // the root's pose is the body's, by whichever of the two it was said
    out.start.said_position |= out.parts.front().start.said_position;
    out.start.said_rotation |= out.parts.front().start.said_rotation;
  }
  std::unordered_map<const Joint*, std::size_t> joint_number;
  for (const auto& joint : body.joints()) {
    joint_number[joint.get()] = out.joints.size();
    const Pose from = joint->parent().pose() * joint->spec().frame_in_parent;
    const Pose to = joint->child().pose() * joint->spec().frame_in_child;
    out.joints.push_back({joint->name(), rows_of(store, joint->id()), joint->spec(), number[&joint->parent()],
                          number[&joint->child()], from.inverse() * to});
  }
  for (const auto& motor : body.motors()) {
    out.motors.push_back({joint_number[&motor->joint()], rows_of(store, motor->id())});
  }
  for (const PartPair& pair : body.pairs().list) {
    if (pair.edit != PairEdit::none) out.pairs.push_back({pair.a, pair.b, pair.edit});
  }
  for (const Behavior* behavior : body.behaviors()) {
    out.behaviors.push_back({behavior->name(), behavior->type().name, behavior->type().table, behavior->setup(),
                             behavior->group() != nullptr, rows_of(store, behavior->id())});
  }
  return out;
}

}  // namespace

std::uint64_t described_rows(const Table& table) {
  std::uint64_t rows = 0;
  for (const Row& row : table.rows()) {
    const bool pose = &table == &Part::table() && (row.name == "position" || row.name == "rotation");
    if (row.stored() && row.writable() && !pose) rows |= std::uint64_t{1} << row.index;
  }
  return rows;
}

std::uint64_t said_rows(const SaidRows& rows) {
  std::uint64_t said = 0;
  for (const SaidRow& row : rows) said |= std::uint64_t{row.said} << row.row;
  return said;
}

BodyDescription describe_body(const Body& body) {
  const World& world = body.world();
  Shapes shapes;
  for (const auto& part : body.parts()) {
    if (!world.store().alive(part->shape()) || shapes.contains(part->shape().slot)) continue;
    shapes[part->shape().slot] =
        describe_shape(world.store(), *static_cast<const Shape*>(world.store().thing(part->shape())));
  }
  return body_of(body, shapes);
}

Description describe(const World& world) {
  Description out;
  out.world = rows_of(world.store(), world.id());
  out.visuals = rows_of(world.store(), world.visuals().id());
  out.camera = rows_of(world.store(), world.visuals().camera().id());
  out.look = rows_of(world.store(), world.visuals().look().id());
  Shapes shapes;
  for (const auto& shape : world.shapes()) {
    out.shapes.push_back(describe_shape(world.store(), *shape));
    shapes[shape->id().slot] = out.shapes.back();
  }
  out.bodies.reserve(world.bodies().size());
  for (const auto& body : world.bodies()) out.bodies.push_back(body_of(*body, shapes));
  for (const auto& gear : world.gears()) {
    const Joint& a = gear->joint_a();
    const Joint& b = gear->joint_b();
    out.gears.push_back(
        {gear->name(), a.body().name(), a.name(), b.body().name(), b.name(), rows_of(world.store(), gear->id())});
  }
  for (const BehaviorGroup* group : world.behaviors().groups()) {
    out.groups.push_back({group->name(), group->type().name, group->type().group_table, group->setup(),
                          rows_of(world.store(), group->id())});
  }
  out.behavior_order = world.behaviors().order();
  return out;
}

}  // namespace limber
