// World: changes made by a reload: removed shapes, rebuilt bodies, and the order of both.
#include <algorithm>

#include <fmt/format.h>

#include "base/check.h"
#include "sim/state/body_state.h"
#include "sim/world/world.h"

namespace limber {

namespace {

// Moves the elements of `first` to the front, in this order; the others follow in their previous order.
template <class T>
void move_to_front(Store& store, NodeId group, std::vector<std::unique_ptr<T>>& list, const std::vector<T*>& first) {
  const auto in_place = [](const std::unique_ptr<T>& element, const T* wanted) { return element.get() == wanted; };
  if (first.size() <= list.size() &&
      std::equal(first.begin(), first.end(), list.begin(), [&](const T* a, const auto& b) { return in_place(b, a); })) {
    return;
  }
  std::vector<NodeId> ids;
  std::vector<std::uint32_t> rank(store.view()->slot_count, static_cast<std::uint32_t>(first.size()));
  for (const T* object : first) {
    rank[object->id().slot] = static_cast<std::uint32_t>(ids.size());
    ids.push_back(object->id());
  }
  std::stable_sort(list.begin(), list.end(),
                   [&](const auto& a, const auto& b) { return rank[a->id().slot] < rank[b->id().slot]; });
  store.order_children(group, ids);
}

}  // namespace

void World::flush_detached() {
  store_.flush();
  for (const auto& body : bodies_) body->update_moved_joints();
}

Body& World::rebuild_body(Body& body, const Body& blueprint, const std::vector<bool>& joints_to_reset) {
  const BodyState state(body);
  // gears on its joints are reattached to the joints of the same name of the new body, if these exist
  struct AttachedGear {
    std::unique_ptr<Gear> gear;
    std::size_t index;
    std::string joint_a, joint_b;  // names of joints of the replaced body; empty: the joint of another body
  };
  std::vector<AttachedGear> attached;
  for (std::size_t i = gears_.size(); i-- > 0;) {
    Gear& gear = *gears_[i];
    if (!gear.couples(body)) continue;
    gear.remove_constraint();
    const auto name_on_body = [&](const Joint& joint) { return &joint.body() == &body ? joint.name() : std::string(); };
    attached.push_back({std::move(gears_[i]), i, name_on_body(gear.joint_a()), name_on_body(gear.joint_b())});
    gears_.erase(gears_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  remove_body(body);
  const Result<Body*> copied = copy_body(blueprint, blueprint.name());
  LIMBER_CHECK(copied.ok());
  Body& replacement = **copied;
  replacement.prepare_step();  // finds overlaps in the poses of the blueprint, not in those restored below
  replacement.save_start_pose(blueprint);
  state.apply_to(replacement, joints_to_reset);
  for (auto entry = attached.rbegin(); entry != attached.rend(); ++entry) {
    Gear& gear = *entry->gear;
    Joint* const a = entry->joint_a.empty() ? &gear.joint_a() : replacement.find_joint(entry->joint_a);
    Joint* const b = entry->joint_b.empty() ? &gear.joint_b() : replacement.find_joint(entry->joint_b);
    if (a == nullptr || b == nullptr || !check_gear_joint(*a) || !check_gear_joint(*b)) continue;
    gear.replace_joints(*a, *b);
    const std::size_t index = std::min(entry->index, gears_.size());
    gears_.insert(gears_.begin() + static_cast<std::ptrdiff_t>(index), std::move(entry->gear));
  }
  return replacement;
}

void World::add_shapes_for(const BodyModel& model) {
  for (const LinkModel& link : model.links) {
    for (std::size_t i = 0; i < link.visuals.size(); i++) {
      const PlacedShape& visual = link.visuals[i];
      std::string name = visual_shape_name(model, link, i);
      if (find_shape(name) != nullptr) continue;
      if (const Result<Shape*> shape = add_shape(std::move(name), visual.shape)) (*shape)->set_color(visual);
    }
  }
}

void World::remove_shape(Shape& shape) {
  std::erase_if(shapes_, [&](const std::unique_ptr<Shape>& s) { return s.get() == &shape; });
}

NodeId World::matching_shape(const World& other, NodeId shape) const {
  if (&other == this || !other.store_.alive(shape)) return shape;
  const Shape* const found = find_shape(other.store_.name(shape));
  return found == nullptr ? NodeId{} : found->id();
}

void World::move_gears_to_front(const std::vector<Gear*>& first) { move_to_front(store_, gear_group_, gears_, first); }

void World::move_bodies_to_front(const std::vector<Body*>& first) {
  move_to_front(store_, body_group_, bodies_, first);
}

void World::move_shapes_to_front(const std::vector<Shape*>& first) {
  move_to_front(store_, shape_group_, shapes_, first);
}

}  // namespace limber
