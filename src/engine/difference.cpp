// Comparing two descriptions.
#include "engine/difference.h"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <unordered_map>

namespace limber {

namespace {

bool same_mesh(const std::shared_ptr<const MeshModel>& a, const std::shared_ptr<const MeshModel>& b) {
  if (a == b) return true;
  return a != nullptr && b != nullptr && a->hull == b->hull && a->vertices == b->vertices &&
         a->triangles == b->triangles;
}

bool same_geometry(const ShapeModel& a, const ShapeModel& b) {
  return a.kind == b.kind && a.normal == b.normal && a.size == b.size && a.radius == b.radius && a.height == b.height &&
         same_mesh(a.mesh, b.mesh) && nearly_same(a.mesh_pose, b.mesh_pose);
}

bool same_geometry(const ShapeDescription& a, const ShapeDescription& b) {
  return same_geometry(a.model, b.model) &&
         std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(),
                    [](const PlacedShape& x, const PlacedShape& y) {
                      return same_geometry(x.shape, y.shape) && nearly_same(x.origin, y.origin);
                    });
}

bool same_making(const PartDescription& a, const PartDescription& b) {
  if (a.name != b.name || a.is_static != b.is_static || (a.shape == nullptr) != (b.shape == nullptr)) return false;
  return a.shape == b.shape || (a.shape->name == b.shape->name && same_geometry(*a.shape, *b.shape));
}

bool same_mimic(const std::optional<Mimic>& a, const std::optional<Mimic>& b) {
  if (!a || !b) return !a && !b;
  return a->leader == b->leader && a->multiplier == b->multiplier && a->offset == b->offset;
}

bool same_making(const JointDescription& a, const JointDescription& b) {
  return a.name == b.name && a.parent == b.parent && a.child == b.child && a.spec.type == b.spec.type &&
         a.spec.friction == b.spec.friction && same_mimic(a.spec.mimic, b.spec.mimic) &&
         nearly_same(a.spec.frame_in_parent, b.spec.frame_in_parent) &&
         nearly_same(a.spec.frame_in_child, b.spec.frame_in_child) && nearly_same(a.start, b.start);
}

bool same_making(const MotorDescription& a, const MotorDescription& b) { return a.joint == b.joint; }

template <class T>
bool all_made_the_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same_making(x, y); });
}

// by content: which of two equal models a run has got depends on what was loaded before
bool same_model(const std::shared_ptr<const BodyModel>& a, const std::shared_ptr<const BodyModel>& b) {
  return a == b || (a != nullptr && b != nullptr && a->content == b->content);
}

bool same_making(const BodyDescription& a, const BodyDescription& b) {
  return same_model(a.model, b.model) && all_made_the_same(a.parts, b.parts) && all_made_the_same(a.joints, b.joints) &&
         all_made_the_same(a.motors, b.motors);
}

template <class T>
const T* named(const std::vector<T>& list, std::string_view name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const T& t) { return t.name == name; });
  return found == list.end() ? nullptr : &*found;
}

const MotorDescription* motor_of(const BodyDescription& body, std::string_view joint) {
  for (const MotorDescription& motor : body.motors) {
    if (body.joints[motor.joint].name == joint) return &motor;
  }
  return nullptr;
}

// said for the first time, or told differently
bool other_place(const Vec3& before, bool said_before, const Vec3& now, bool said) {
  return (said && !said_before) || !nearly_same(before, now);
}
bool other_place(const Quat& before, bool said_before, const Quat& now, bool said) {
  return (said && !said_before) || !nearly_same(before, now);
}
bool other_position(const StartPlace& before, const StartPlace& now) {
  return other_place(before.pose.position, before.said_position, now.pose.position, now.said_position);
}
bool other_rotation(const StartPlace& before, const StartPlace& now) {
  return other_place(before.pose.rotation, before.said_rotation, now.pose.rotation, now.said_rotation);
}

// what is made the same stands at the same number
template <class T>
const T* counterpart(const std::vector<T>& before, const std::vector<T>& now, std::size_t i, bool anew) {
  return anew ? named(before, now[i].name) : &before[i];
}

// trees beside the root's: one that was moved along with the root goes along, one whose own place is told differently
// goes there
void compare_trees(const BodyDescription& before, const BodyDescription& now, const Pose& root_moved,
                   BodyDifference& out) {
  for (std::size_t i = 0; i < now.parts.size(); i++) {
    const PartDescription& part = now.parts[i];
    if (part.tree != i || now.parts.front().tree == i) continue;
    const PartDescription* const was = counterpart(before.parts, now.parts, i, out.anew);
    if (was == nullptr) continue;
    const bool said_first = (part.start.said_position && !was->start.said_position) ||
                            (part.start.said_rotation && !was->start.said_rotation);
    if (!said_first && nearly_same(was->start.pose, part.start.pose)) continue;
    const bool along = !said_first && nearly_same(root_moved * was->start.pose, part.start.pose);
    (along ? out.trees_along : out.trees_placed).push_back(i);
  }
}

void compare_places(const BodyDescription& before, const BodyDescription& now, BodyDifference& out) {
  // parts may have changed places: the root is then compared with what it was
  const PartDescription* const root = now.parts.empty() ? nullptr : named(before.parts, now.parts.front().name);
  const bool was_root = root == nullptr || root == before.parts.data();
  const StartPlace& start = was_root ? before.start : root->start;
  out.position = other_position(start, now.start);
  out.rotation = other_rotation(start, now.start);
  compare_trees(before, now, now.start.pose * start.pose.inverse(), out);
  const auto same_start = [](const PartDescription& a, const PartDescription& b) {
    return nearly_same(a.start.pose, b.start.pose);
  };
  out.start = !std::equal(before.parts.begin(), before.parts.end(), now.parts.begin(), now.parts.end(), same_start);
  for (std::size_t i = 0; i < now.joints.size(); i++) {
    const JointDescription* const was = counterpart(before.joints, now.joints, i, out.anew);
    out.joints_start_anew.push_back(was == nullptr || !nearly_same(was->start, now.joints[i].start));
  }
}

const PairDescription* pair_named(const BodyDescription& body, std::string_view a, std::string_view b) {
  const auto found = std::find_if(body.pairs.begin(), body.pairs.end(), [&](const PairDescription& pair) {
    const std::string_view first = body.parts[pair.a].name;
    const std::string_view second = body.parts[pair.b].name;
    return (first == a && second == b) || (first == b && second == a);
  });
  return found == body.pairs.end() ? nullptr : &*found;
}

// pairs by the names of their parts: those whose edit differs, and those that are no longer edited
void compare_pairs(const BodyDescription& before, const BodyDescription& now, BodyDifference& out) {
  for (const PairDescription& pair : now.pairs) {
    const PairDescription* const was = pair_named(before, now.parts[pair.a].name, now.parts[pair.b].name);
    if (was == nullptr || was->edit != pair.edit) out.pairs.push_back(pair);
  }
  for (const PairDescription& pair : before.pairs) {
    const PartDescription* const a = named(now.parts, before.parts[pair.a].name);
    const PartDescription* const b = named(now.parts, before.parts[pair.b].name);
    if (a == nullptr || b == nullptr || pair_named(now, a->name, b->name) != nullptr) continue;
    out.pairs.push_back({static_cast<std::size_t>(a - now.parts.data()), static_cast<std::size_t>(b - now.parts.data()),
                         PairEdit::none});
  }
}

// of a thing that was not described before, what is said counts
std::uint64_t rows_to_set(const SaidRows* before, const SaidRows& now) {
  return before == nullptr ? said_rows(now) : changed_rows(*before, now);
}

BodyDifference compare_bodies(const BodyDescription& before, const BodyDescription& now) {
  BodyDifference out;
  out.anew = !same_making(before, now);
  out.rows = changed_rows(before.rows, now.rows);
  const auto set = [&](std::vector<std::uint64_t>& rows, const auto* was, const SaidRows& is) {
    rows.push_back(rows_to_set(was == nullptr ? nullptr : &was->rows, is));
  };
  for (std::size_t i = 0; i < now.parts.size(); i++)
    set(out.parts, counterpart(before.parts, now.parts, i, out.anew), now.parts[i].rows);
  for (std::size_t i = 0; i < now.joints.size(); i++)
    set(out.joints, counterpart(before.joints, now.joints, i, out.anew), now.joints[i].rows);
  for (std::size_t i = 0; i < now.motors.size(); i++) {
    const MotorDescription& motor = now.motors[i];
    set(out.motors, out.anew ? motor_of(before, now.joints[motor.joint].name) : &before.motors[i], motor.rows);
  }
  compare_pairs(before, now, out);
  compare_places(before, now, out);
  return out;
}

// the same of two tables that may be different ones: rows are then compared by name, defaults too
std::uint64_t changed_rows(const Table& table_before, const SaidRows& before, const Table& table_now,
                           const SaidRows& now) {
  if (&table_before == &table_now) return changed_rows(before, now);
  const auto value_of = [](const Table&, const SaidRows& rows, const Row& row) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const SaidRow& r) { return r.row == row.index; });
    return found == rows.end() ? SaidRow{row.index, false, row.initial} : *found;
  };
  std::uint64_t rows = 0;
  for (const Row& row : table_now.rows()) {
    if (!row.stored() || !row.writable()) continue;
    const SaidRow is = value_of(table_now, now, row);
    const Row* const known = table_before.find(row.name);
    const bool same_type = known != nullptr && known->type == row.type && known->choices == row.choices;
    const SaidRow was = same_type ? value_of(table_before, before, *known) : SaidRow{row.index, !is.said, {}};
    if (was.said != is.said || !std::equal(was.values.begin(), was.values.begin() + row.width, is.values.begin()))
      rows |= std::uint64_t{1} << row.index;
  }
  return rows;
}

template <class T>
BehaviorDifference compare_behavior(const T* before, const T& now, bool same_setup) {
  if (before == nullptr) return {false, false, said_rows(now.rows)};
  return {true, before->type != now.type || !same_setup,
          changed_rows(*before->table, before->rows, *now.table, now.rows)};
}

std::vector<BehaviorDifference> compare_behaviors(const BodyDescription* before, const BodyDescription& now) {
  std::vector<BehaviorDifference> out;
  for (const BehaviorDescription& is : now.behaviors) {
    const BehaviorDescription* const was = before == nullptr ? nullptr : named(before->behaviors, is.name);
    const bool same = was != nullptr && was->of_group == is.of_group && (is.of_group || was->setup == is.setup);
    out.push_back(compare_behavior(was, is, same));
  }
  return out;
}

template <class T, class Name>
std::vector<std::optional<std::size_t>> match(const std::vector<T>& before, const std::vector<T>& now, Name name,
                                              std::vector<std::size_t>& gone) {
  std::unordered_map<std::string_view, std::size_t> numbers;
  for (std::size_t i = 0; i < before.size(); i++) numbers[name(before[i])] = i;
  std::vector<std::optional<std::size_t>> was;
  std::vector<bool> stays(before.size());
  for (const T& thing : now) {
    const auto found = numbers.find(name(thing));
    was.push_back(found == numbers.end() ? std::nullopt : std::optional(found->second));
    if (was.back()) stays[*was.back()] = true;
  }
  for (std::size_t i = 0; i < before.size(); i++) {
    if (!stays[i]) gone.push_back(i);
  }
  return was;
}

bool none(const std::vector<std::uint64_t>& rows) {
  return std::all_of(rows.begin(), rows.end(), [](std::uint64_t r) { return r == 0; });
}

}  // namespace

bool BodyDifference::empty() const {
  return before && !anew && rows == 0 && none(parts) && none(joints) && none(motors) && pairs.empty() && !position &&
         !rotation && trees_along.empty() && trees_placed.empty() && !start;
}

bool Difference::empty() const {
  const auto there = [](const std::optional<std::size_t>& before) { return before.has_value(); };
  const auto same = [](const BehaviorDifference& d) { return d.described && !d.anew && d.rows == 0; };
  const auto all_same = [&](const auto& list) { return std::all_of(list.begin(), list.end(), same); };
  const auto same_gear = [](const GearDifference& d) { return d.described && d.same_joints && d.rows == 0; };
  return !other_order && gone_gears.empty() && std::all_of(gears.begin(), gears.end(), same_gear) &&
         gone_behaviors.empty() && gone_groups.empty() && all_same(groups) &&
         std::all_of(behaviors.begin(), behaviors.end(), all_same) && world == 0 && visuals == 0 && camera == 0 &&
         look == 0 && shapes.empty() && bodies.empty() && gone_shapes.empty() && gone_bodies.empty() &&
         std::all_of(shapes_before.begin(), shapes_before.end(), there) &&
         std::all_of(bodies_before.begin(), bodies_before.end(), there);
}

std::uint64_t changed_rows(const SaidRows& before, const SaidRows& now) {
  std::uint64_t rows = 0;
  auto b = before.begin();
  auto n = now.begin();
  while (b != before.end() || n != now.end()) {
    // one that is left out was not said and has the table's default
    if (n == now.end() || (b != before.end() && b->row < n->row)) {
      rows |= std::uint64_t{1} << b++->row;
    } else if (b == before.end() || n->row < b->row) {
      rows |= std::uint64_t{1} << n++->row;
    } else {
      if (b->said != n->said || b->values != n->values) rows |= std::uint64_t{1} << n->row;
      ++b;
      ++n;
    }
  }
  return rows;
}

BodyDifference compare_stranger(const BodyDescription& stands, const BodyDescription& now) {
  BodyDifference out;
  out.anew = !same_making(stands, now);
  out.rows = said_rows(now.rows);
  for (const PartDescription& part : now.parts) out.parts.push_back(said_rows(part.rows));
  for (const JointDescription& joint : now.joints) out.joints.push_back(said_rows(joint.rows));
  for (const MotorDescription& motor : now.motors) out.motors.push_back(said_rows(motor.rows));
  out.pairs = now.pairs;
  out.position = now.start.said_position;
  out.rotation = now.start.said_rotation;
  for (std::size_t i = 0; i < now.parts.size(); i++) {
    const PartDescription& part = now.parts[i];
    if (part.tree != i || now.parts.front().tree == i) continue;
    if (part.start.said_position || part.start.said_rotation) out.trees_placed.push_back(i);
  }
  out.start = true;
  return out;
}

namespace {

void compare_behaviors(const Description& before, const Description& now, Difference& out) {
  for (std::size_t i = 0; i < now.bodies.size(); i++) {
    const std::optional<std::size_t> was = out.bodies_before[i];
    out.behaviors.push_back(compare_behaviors(was ? &before.bodies[*was] : nullptr, now.bodies[i]));
    if (!was) continue;
    for (const BehaviorDescription& behavior : before.bodies[*was].behaviors) {
      if (named(now.bodies[i].behaviors, behavior.name) == nullptr) out.gone_behaviors.emplace_back(i, behavior.name);
    }
  }
  for (const GroupDescription& is : now.groups) {
    const GroupDescription* const was = named(before.groups, is.name);
    out.groups.push_back(compare_behavior(was, is, was != nullptr && was->setup == is.setup));
  }
  for (const GroupDescription& was : before.groups) {
    if (named(now.groups, was.name) == nullptr) out.gone_groups.push_back(was.name);
  }
  out.other_order = before.behavior_order != now.behavior_order;
}

void compare_gears(const Description& before, const Description& now, Difference& out) {
  const auto joints = [](const GearDescription& g) { return std::tie(g.body_a, g.joint_a, g.body_b, g.joint_b); };
  for (const GearDescription& is : now.gears) {
    const GearDescription* const was = named(before.gears, is.name);
    const bool same_joints = was != nullptr && joints(*was) == joints(is);
    out.gears.push_back({was != nullptr, same_joints, rows_to_set(was == nullptr ? nullptr : &was->rows, is.rows)});
  }
  for (const GearDescription& was : before.gears) {
    if (named(now.gears, was.name) == nullptr) out.gone_gears.push_back(was.name);
  }
}

}  // namespace

Difference compare(const Description& before, const Description& now) {
  Difference out;
  out.world = changed_rows(before.world, now.world);
  out.visuals = changed_rows(before.visuals, now.visuals);
  out.camera = changed_rows(before.camera, now.camera);
  out.look = changed_rows(before.look, now.look);
  out.shapes_before = match(
      before.shapes, now.shapes, [](const auto& s) { return std::string_view(s->name); }, out.gone_shapes);
  out.bodies_before = match(
      before.bodies, now.bodies, [](const auto& b) { return std::string_view(b.name); }, out.gone_bodies);
  for (std::size_t i = 0; i < now.shapes.size(); i++) {
    if (!out.shapes_before[i]) continue;
    const ShapeDescription& was = *before.shapes[*out.shapes_before[i]];
    const ShapeDifference difference{i, !same_geometry(was, *now.shapes[i]),
                                     changed_rows(was.rows, now.shapes[i]->rows)};
    if (difference.geometry || difference.rows != 0) out.shapes.push_back(difference);
  }
  for (std::size_t i = 0; i < now.bodies.size(); i++) {
    if (!out.bodies_before[i]) continue;
    BodyDifference difference = compare_bodies(before.bodies[*out.bodies_before[i]], now.bodies[i]);
    difference.now = i;
    difference.before = out.bodies_before[i];
    if (!difference.empty()) out.bodies.push_back(std::move(difference));
  }
  compare_gears(before, now, out);
  compare_behaviors(before, now, out);
  return out;
}

}  // namespace limber
