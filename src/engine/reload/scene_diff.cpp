// SceneDiff: comparison of two scene specs.
#include "engine/reload/scene_diff.h"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <unordered_map>

#include "model/look/mesh_look.h"

namespace limber::engine {

namespace {

bool same_geometry(const model::ShapeModel& a, const model::ShapeModel& b);

bool same_pieces(const std::vector<model::PlacedShape>& a, const std::vector<model::PlacedShape>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const model::PlacedShape& x, const model::PlacedShape& y) {
                      return same_geometry(x.shape, y.shape) && nearly_same(x.origin, y.origin);
                    });
}

bool same_mesh(const std::shared_ptr<const model::MeshModel>& a, const std::shared_ptr<const model::MeshModel>& b) {
  if (a == b) return true;
  return a != nullptr && b != nullptr && a->hull == b->hull && a->vertices == b->vertices &&
         a->triangles == b->triangles && same_pieces(a->pieces, b->pieces) && same_look(*a, *b);
}

bool same_geometry(const model::ShapeModel& a, const model::ShapeModel& b) {
  return a.kind == b.kind && a.normal == b.normal && a.size == b.size && a.radius == b.radius && a.height == b.height &&
         same_mesh(a.mesh, b.mesh) && (a.surface == nullptr) == (b.surface == nullptr) &&
         nearly_same(a.mesh_pose, b.mesh_pose) && a.mesh_colors == b.mesh_colors && same_image(a.texture, b.texture);
}

bool same_geometry(const ShapeDescription& a, const ShapeDescription& b) {
  return same_geometry(a.model, b.model) && same_pieces(a.children, b.children);
}

bool same_construction(const PartDescription& a, const PartDescription& b) {
  if (a.name != b.name || a.is_static != b.is_static || (a.shape == nullptr) != (b.shape == nullptr)) return false;
  return a.shape == b.shape || (a.shape->name == b.shape->name && same_geometry(*a.shape, *b.shape));
}

bool same_mimic(const std::optional<sim::Mimic>& a, const std::optional<sim::Mimic>& b) {
  if (!a || !b) return !a && !b;
  return a->leader == b->leader && a->multiplier == b->multiplier && a->offset == b->offset;
}

bool same_construction(const JointDescription& a, const JointDescription& b) {
  return a.name == b.name && a.parent == b.parent && a.child == b.child && a.spec.type == b.spec.type &&
         a.spec.friction == b.spec.friction && same_mimic(a.spec.mimic, b.spec.mimic) &&
         nearly_same(a.spec.frame_in_parent, b.spec.frame_in_parent) &&
         nearly_same(a.spec.frame_in_child, b.spec.frame_in_child) && nearly_same(a.start, b.start);
}

bool same_construction(const MotorDescription& a, const MotorDescription& b) { return a.joint == b.joint; }

bool same_construction(const SensorDescription& a, const SensorDescription& b) {
  return a.name == b.name && a.kind == b.kind && a.part == b.part;
}

template <class T>
bool all_same_construction(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& x, const T& y) { return same_construction(x, y); });
}

// Compares by content, because the model cache may return either of two equal models.
bool same_model(const std::shared_ptr<const model::BodyModel>& a, const std::shared_ptr<const model::BodyModel>& b) {
  return a == b || (a != nullptr && b != nullptr && a->content_hash == b->content_hash);
}

bool same_construction(const BodyDescription& a, const BodyDescription& b) {
  return same_model(a.model, b.model) && all_same_construction(a.parts, b.parts) &&
         all_same_construction(a.joints, b.joints) && all_same_construction(a.motors, b.motors) &&
         all_same_construction(a.sensors, b.sensors);
}

template <class T>
const T* find_named(const std::vector<T>& list, std::string_view name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const T& t) { return t.name == name; });
  return found == list.end() ? nullptr : &*found;
}

const MotorDescription* motor_of(const BodyDescription& body, std::string_view joint) {
  for (const MotorDescription& motor : body.motors) {
    if (body.joints[motor.joint].name == joint) return &motor;
  }
  return nullptr;
}

// True if the start pose is set for the first time or to another value.
bool start_differs(const Vec3& before, bool set_before, const Vec3& now, bool set_now) {
  return (set_now && !set_before) || !nearly_same(before, now);
}
bool start_differs(const Quat& before, bool set_before, const Quat& now, bool set_now) {
  return (set_now && !set_before) || !nearly_same(before, now);
}
bool position_differs(const StartPose& before, const StartPose& now) {
  return start_differs(before.pose.position, before.position_set, now.pose.position, now.position_set);
}
bool rotation_differs(const StartPose& before, const StartPose& now) {
  return start_differs(before.pose.rotation, before.rotation_set, now.pose.rotation, now.rotation_set);
}

// Returns the old element that corresponds to element `i`: at the same index if the body is not rebuilt, else by name.
template <class T>
const T* old_counterpart(const std::vector<T>& before, const std::vector<T>& now, std::size_t i, bool rebuild) {
  return rebuild ? find_named(before, now[i].name) : &before[i];
}

// Compares trees other than the root's: those with the same offset from the root move along with it; those with another
// start pose of their own move there.
void compare_trees(const BodyDescription& before, const BodyDescription& now, const Pose& root_moved, BodyDiff& out) {
  for (std::size_t i = 0; i < now.parts.size(); i++) {
    const PartDescription& part = now.parts[i];
    if (part.tree != i || now.parts.front().tree == i) continue;
    const PartDescription* const old_part = old_counterpart(before.parts, now.parts, i, out.rebuild);
    if (old_part == nullptr) continue;
    const bool newly_set = (part.start.position_set && !old_part->start.position_set) ||
                           (part.start.rotation_set && !old_part->start.rotation_set);
    if (!newly_set && nearly_same(old_part->start.pose, part.start.pose)) continue;
    const bool moves_along = !newly_set && nearly_same(root_moved * old_part->start.pose, part.start.pose);
    (moves_along ? out.trees_with_root : out.trees_placed).push_back(i);
  }
}

void compare_start_poses(const BodyDescription& before, const BodyDescription& now, BodyDiff& out) {
  // if the root was another part before, compare with the start pose of that part
  const PartDescription* const root = now.parts.empty() ? nullptr : find_named(before.parts, now.parts.front().name);
  const bool was_root = root == nullptr || root == before.parts.data();
  const StartPose& start = was_root ? before.start : root->start;
  out.position_changed = position_differs(start, now.start);
  out.rotation_changed = rotation_differs(start, now.start);
  compare_trees(before, now, now.start.pose * start.pose.inverse(), out);
  const auto same_start = [](const PartDescription& a, const PartDescription& b) {
    return nearly_same(a.start.pose, b.start.pose);
  };
  out.start_changed =
      !std::equal(before.parts.begin(), before.parts.end(), now.parts.begin(), now.parts.end(), same_start);
  for (std::size_t i = 0; i < now.joints.size(); i++) {
    const JointDescription* const old_joint = old_counterpart(before.joints, now.joints, i, out.rebuild);
    out.joints_to_reset.push_back(old_joint == nullptr || !nearly_same(old_joint->start, now.joints[i].start));
  }
}

const PairDescription* find_pair(const BodyDescription& body, std::string_view a, std::string_view b) {
  const auto found = std::find_if(body.pairs.begin(), body.pairs.end(), [&](const PairDescription& pair) {
    const std::string_view first = body.parts[pair.a].name;
    const std::string_view second = body.parts[pair.b].name;
    return (first == a && second == b) || (first == b && second == a);
  });
  return found == body.pairs.end() ? nullptr : &*found;
}

// Compares pairs by the names of their parts: finds changed edits and removed ones.
void compare_pairs(const BodyDescription& before, const BodyDescription& now, BodyDiff& out) {
  for (const PairDescription& pair : now.pairs) {
    const PairDescription* const old_pair = find_pair(before, now.parts[pair.a].name, now.parts[pair.b].name);
    if (old_pair == nullptr || old_pair->edit != pair.edit) out.pairs.push_back(pair);
  }
  for (const PairDescription& pair : before.pairs) {
    const PartDescription* const a = find_named(now.parts, before.parts[pair.a].name);
    const PartDescription* const b = find_named(now.parts, before.parts[pair.b].name);
    if (a == nullptr || b == nullptr || find_pair(now, a->name, b->name) != nullptr) continue;
    out.pairs.push_back({static_cast<std::size_t>(a - now.parts.data()), static_cast<std::size_t>(b - now.parts.data()),
                         sim::PairEdit::none});
  }
}

// For an object without an old spec, returns the explicitly set properties.
std::uint64_t mask_to_set(const SpecValues* before, const SpecValues& now) {
  return before == nullptr ? explicit_mask(now) : changed_mask(*before, now);
}

BodyDiff compare_bodies(const BodyDescription& before, const BodyDescription& now) {
  BodyDiff out;
  out.rebuild = !same_construction(before, now);
  const auto add_mask = [&](const auto* old_element, const SpecValues& new_values) {
    out.changed.push_back(mask_to_set(old_element == nullptr ? nullptr : &old_element->values, new_values));
  };
  add_mask(&before, now.values);
  for (std::size_t i = 0; i < now.parts.size(); i++)
    add_mask(old_counterpart(before.parts, now.parts, i, out.rebuild), now.parts[i].values);
  for (std::size_t i = 0; i < now.joints.size(); i++)
    add_mask(old_counterpart(before.joints, now.joints, i, out.rebuild), now.joints[i].values);
  for (std::size_t i = 0; i < now.motors.size(); i++) {
    const MotorDescription& motor = now.motors[i];
    add_mask(out.rebuild ? motor_of(before, now.joints[motor.joint].name) : &before.motors[i], motor.values);
  }
  for (std::size_t i = 0; i < now.sensors.size(); i++) {
    const SensorDescription* const old_sensor = old_counterpart(before.sensors, now.sensors, i, out.rebuild);
    const bool same_kind = old_sensor != nullptr && old_sensor->kind == now.sensors[i].kind;
    add_mask(same_kind ? old_sensor : nullptr, now.sensors[i].values);
  }
  compare_pairs(before, now, out);
  compare_start_poses(before, now, out);
  return out;
}

// Compares values of two tables, which may differ after a reload of a behavior's type: properties are then compared by
// name, including defaults.
std::uint64_t changed_mask(const PropertyTable& table_before, const SpecValues& before, const PropertyTable& table_now,
                           const SpecValues& now) {
  if (&table_before == &table_now) return changed_mask(before, now);
  const auto value_of = [](const PropertyTable&, const SpecValues& values, const Property& property) {
    const auto found =
        std::find_if(values.begin(), values.end(), [&](const SpecValue& r) { return r.property == property.index; });
    return found == values.end() ? SpecValue{property.index, false, property.initial} : *found;
  };
  std::uint64_t mask = 0;
  for (const Property& property : table_now.properties()) {
    if (!property.stored() || !property.writable()) continue;
    const SpecValue new_value = value_of(table_now, now, property);
    const Property* const old_property = table_before.find(property.name);
    const bool same_type =
        old_property != nullptr && old_property->type == property.type && old_property->choices == property.choices;
    const SpecValue old_value =
        same_type ? value_of(table_before, before, *old_property) : SpecValue{property.index, !new_value.is_set, {}};
    if (old_value.is_set != new_value.is_set ||
        !std::equal(old_value.values.begin(), old_value.values.begin() + property.width, new_value.values.begin()))
      mask |= std::uint64_t{1} << property.index;
  }
  return mask;
}

template <class T>
BehaviorDiff compare_behavior(const T* before, const T& now, bool same_setup) {
  if (before == nullptr) return {false, false, explicit_mask(now.values)};
  return {true, before->type != now.type || !same_setup,
          changed_mask(*before->table, before->values, *now.table, now.values)};
}

std::vector<BehaviorDiff> compare_behaviors(const BodyDescription* before, const BodyDescription& now) {
  std::vector<BehaviorDiff> out;
  for (const BehaviorDescription& item : now.behaviors) {
    const BehaviorDescription* const old_item = before == nullptr ? nullptr : find_named(before->behaviors, item.name);
    const bool same =
        old_item != nullptr && old_item->of_group == item.of_group && (item.of_group || old_item->setup == item.setup);
    out.push_back(compare_behavior(old_item, item, same));
  }
  return out;
}

template <class T, class Name>
std::vector<std::optional<std::size_t>> match(const std::vector<T>& before, const std::vector<T>& now, Name name,
                                              std::vector<std::size_t>& removed) {
  std::unordered_map<std::string_view, std::size_t> old_index_by_name;
  for (std::size_t i = 0; i < before.size(); i++) old_index_by_name[name(before[i])] = i;
  std::vector<std::optional<std::size_t>> old_indices;
  std::vector<bool> still_exists(before.size());
  for (const T& item : now) {
    const auto found = old_index_by_name.find(name(item));
    old_indices.push_back(found == old_index_by_name.end() ? std::nullopt : std::optional(found->second));
    if (old_indices.back()) still_exists[*old_indices.back()] = true;
  }
  for (std::size_t i = 0; i < before.size(); i++) {
    if (!still_exists[i]) removed.push_back(i);
  }
  return old_indices;
}

}  // namespace

bool BodyDiff::empty() const {
  const bool same_values = std::ranges::all_of(changed, [](std::uint64_t properties) { return properties == 0; });
  return old_index && !rebuild && same_values && pairs.empty() && !position_changed && !rotation_changed &&
         trees_with_root.empty() && trees_placed.empty() && !start_changed;
}

bool SceneDiff::empty() const {
  const auto all_empty = [](const auto& list) {
    return std::ranges::all_of(list, [](const auto& diff) { return diff.empty(); });
  };
  const auto all_existed = [](const std::vector<std::optional<std::size_t>>& indices) {
    return std::ranges::all_of(indices, [](const auto& index) { return index.has_value(); });
  };
  const bool same_values = std::ranges::all_of(singles, [](std::uint64_t changed) { return changed == 0; });
  const bool same_objects =
      shapes.empty() && bodies.empty() && all_existed(old_shape_indices) && all_existed(old_body_indices);
  const auto all_none = [](const auto&... lists) { return (lists.empty() && ...); };
  const bool none_removed = all_none(removed_shapes, removed_bodies, removed_behaviors, removed_groups);
  return same_values && same_objects && none_removed && !order_changed && all_empty(groups) &&
         all_none(gears, tendons, fixtures, mocap, routes) && std::ranges::all_of(behaviors, all_empty);
}

std::uint64_t changed_mask(const SpecValues& before, const SpecValues& now) {
  std::uint64_t mask = 0;
  auto b = before.begin();
  auto n = now.begin();
  while (b != before.end() || n != now.end()) {
    // an omitted property was not set and has the table's default
    if (n == now.end() || (b != before.end() && b->property < n->property)) {
      mask |= std::uint64_t{1} << b++->property;
    } else if (b == before.end() || n->property < b->property) {
      mask |= std::uint64_t{1} << n++->property;
    } else {
      if (b->is_set != n->is_set || b->values != n->values) mask |= std::uint64_t{1} << n->property;
      ++b;
      ++n;
    }
  }
  return mask;
}

BodyDiff compare_unmanaged(const BodyDescription& existing, const BodyDescription& now) {
  BodyDiff out;
  out.rebuild = !same_construction(existing, now);
  out.changed.push_back(explicit_mask(now.values));
  for (const PartDescription& part : now.parts) out.changed.push_back(explicit_mask(part.values));
  for (const JointDescription& joint : now.joints) out.changed.push_back(explicit_mask(joint.values));
  for (const MotorDescription& motor : now.motors) out.changed.push_back(explicit_mask(motor.values));
  for (const SensorDescription& sensor : now.sensors) out.changed.push_back(explicit_mask(sensor.values));
  out.pairs = now.pairs;
  out.position_changed = now.start.position_set;
  out.rotation_changed = now.start.rotation_set;
  for (std::size_t i = 0; i < now.parts.size(); i++) {
    const PartDescription& part = now.parts[i];
    if (part.tree != i || now.parts.front().tree == i) continue;
    if (part.start.position_set || part.start.rotation_set) out.trees_placed.push_back(i);
  }
  out.start_changed = true;
  return out;
}

namespace {

void compare_behaviors(const SceneSpec& before, const SceneSpec& now, SceneDiff& out) {
  for (std::size_t i = 0; i < now.bodies.size(); i++) {
    const std::optional<std::size_t> old_item = out.old_body_indices[i];
    out.behaviors.push_back(compare_behaviors(old_item ? &before.bodies[*old_item] : nullptr, now.bodies[i]));
    if (!old_item) continue;
    for (const BehaviorDescription& behavior : before.bodies[*old_item].behaviors) {
      if (find_named(now.bodies[i].behaviors, behavior.name) == nullptr)
        out.removed_behaviors.emplace_back(i, behavior.name);
    }
  }
  for (const GroupDescription& item : now.groups) {
    const GroupDescription* const old_item = find_named(before.groups, item.name);
    out.groups.push_back(compare_behavior(old_item, item, old_item != nullptr && old_item->setup == item.setup));
  }
  for (const GroupDescription& old_item : before.groups) {
    if (find_named(now.groups, old_item.name) == nullptr) out.removed_groups.push_back(old_item.name);
  }
  out.order_changed = before.behavior_order != now.behavior_order;
}

template <class Description>
std::string key_of(const Description& object) {
  return object.name;
}
std::pair<std::string, std::string> key_of(const TendonDescription& tendon) { return {tendon.body, tendon.name}; }

// Compares the objects of a class. `same_build` compares the parts of two descriptions that can't be set.
template <class Description, class Key, class SameBuild>
void compare_objects(const std::vector<Description>& before, const std::vector<Description>& now, ObjectDiffs<Key>& out,
                     SameBuild same_build) {
  const auto find = [](const std::vector<Description>& list, const Key& key) {
    const auto found = std::ranges::find_if(list, [&](const Description& each) { return key_of(each) == key; });
    return found == list.end() ? nullptr : &*found;
  };
  for (const Description& object : now) {
    const Description* const old_object = find(before, key_of(object));
    if (old_object == nullptr) {
      out.list.push_back({false, false, mask_to_set(nullptr, object.values)});
    } else {
      out.list.push_back({true, same_build(*old_object, object), mask_to_set(&old_object->values, object.values)});
    }
  }
  for (const Description& old_object : before) {
    const Key key = key_of(old_object);
    if (find(now, key) == nullptr) out.removed.push_back(key);
  }
}

void compare_objects(const SceneSpec& before, const SceneSpec& now, SceneDiff& out) {
  using Gear = GearDescription;
  using Tendon = TendonDescription;
  using Fixture = FixtureDescription;
  using Mocap = MocapDescription;
  using Route = RouteDescription;
  compare_objects(before.gears, now.gears, out.gears, [](const Gear& a, const Gear& b) {
    return std::tie(a.body_a, a.joint_a, a.body_b, a.joint_b) == std::tie(b.body_a, b.joint_a, b.body_b, b.joint_b);
  });
  compare_objects(before.tendons, now.tendons, out.tendons,
                  [](const Tendon& a, const Tendon& b) { return a.points == b.points; });
  compare_objects(before.fixtures, now.fixtures, out.fixtures, [](const Fixture& a, const Fixture& b) {
    return *a.profile == *b.profile && a.targets == b.targets;
  });
  compare_objects(before.mocap, now.mocap, out.mocap,
                  [](const Mocap& a, const Mocap& b) { return *a.setup == *b.setup && a.joints == b.joints; });
  compare_objects(before.routes, now.routes, out.routes,
                  [](const Route& a, const Route& b) { return a.from == b.from && a.to == b.to; });
}

}  // namespace

SceneDiff compare(const SceneSpec& before, const SceneSpec& now) {
  SceneDiff out;
  for (std::size_t i = 0; i < kSingleNodes; i++) out.singles[i] = changed_mask(before.singles[i], now.singles[i]);
  out.old_shape_indices = match(
      before.shapes, now.shapes, [](const auto& s) { return std::string_view(s->name); }, out.removed_shapes);
  out.old_body_indices = match(
      before.bodies, now.bodies, [](const auto& b) { return std::string_view(b.name); }, out.removed_bodies);
  for (std::size_t i = 0; i < now.shapes.size(); i++) {
    if (!out.old_shape_indices[i]) continue;
    const ShapeDescription& old_shape = *before.shapes[*out.old_shape_indices[i]];
    const ShapeDiff diff{i, !same_geometry(old_shape, *now.shapes[i]),
                         changed_mask(old_shape.values, now.shapes[i]->values)};
    if (diff.geometry_changed || diff.changed != 0) out.shapes.push_back(diff);
  }
  for (std::size_t i = 0; i < now.bodies.size(); i++) {
    if (!out.old_body_indices[i]) continue;
    BodyDiff diff = compare_bodies(before.bodies[*out.old_body_indices[i]], now.bodies[i]);
    diff.new_index = i;
    diff.old_index = out.old_body_indices[i];
    if (!diff.empty()) out.bodies.push_back(std::move(diff));
  }
  compare_objects(before, now, out);
  compare_behaviors(before, now, out);
  return out;
}

}  // namespace limber::engine
