// World: what a reload changes in it: shapes that go, bodies that are built anew, the order of both.
#include <algorithm>

#include <fmt/format.h>

#include "base/check.h"
#include "sim/posture.h"
#include "sim/world.h"

namespace limber {

namespace {

// the named ones first, in their order; the others behind, as they stood
template <class T>
void order(Store& store, NodeId group, std::vector<std::unique_ptr<T>>& list, const std::vector<T*>& first) {
  const auto in_place = [](const std::unique_ptr<T>& is, const T* wanted) { return is.get() == wanted; };
  if (first.size() <= list.size() &&
      std::equal(first.begin(), first.end(), list.begin(), [&](const T* a, const auto& b) { return in_place(b, a); })) {
    return;
  }
  std::vector<NodeId> ids;
  std::vector<std::uint32_t> place(store.view()->slot_count, static_cast<std::uint32_t>(first.size()));
  for (const T* thing : first) {
    place[thing->id().slot] = static_cast<std::uint32_t>(ids.size());
    ids.push_back(thing->id());
  }
  std::stable_sort(list.begin(), list.end(),
                   [&](const auto& a, const auto& b) { return place[a->id().slot] < place[b->id().slot]; });
  store.order_children(group, ids);
}

}  // namespace

void World::stand() {
  store_.apply_marks();
  for (const auto& body : bodies_) body->settle_joints();
}

Body& World::rebuild_body(Body& body, const Body& described, const std::vector<bool>& joints_start_anew) {
  const Posture posture(body);
  // gears of its joints stay, where the new body has joints of these names
  struct Coupling {
    std::unique_ptr<Gear> gear;
    std::size_t place;
    std::string of_a, of_b;  // joints of the body
  };
  std::vector<Coupling> couplings;
  for (std::size_t i = gears_.size(); i-- > 0;) {
    Gear& gear = *gears_[i];
    if (!gear.couples(body)) continue;
    gear.leave();
    const auto own = [&](const Joint& joint) { return &joint.body() == &body ? joint.name() : std::string(); };
    couplings.push_back({std::move(gears_[i]), i, own(gear.joint_a()), own(gear.joint_b())});
    gears_.erase(gears_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  remove_body(body);
  const Result<Body*> made = copy_body(described, described.name());
  LIMBER_CHECK(made.ok());
  Body& fresh = **made;
  fresh.take_start_pose(described);
  fresh.fresh_ = false;
  if (fresh.has_unchecked_parts()) fresh.find_overlaps();  // where they are described, not where they moved to
  posture.give_to(fresh, joints_start_anew);
  for (auto coupling = couplings.rbegin(); coupling != couplings.rend(); ++coupling) {
    Gear& gear = *coupling->gear;
    Joint* const a = coupling->of_a.empty() ? &gear.joint_a() : fresh.find_joint(coupling->of_a);
    Joint* const b = coupling->of_b.empty() ? &gear.joint_b() : fresh.find_joint(coupling->of_b);
    if (a == nullptr || b == nullptr || !check_gear_joint(*a) || !check_gear_joint(*b)) continue;
    gear.attach(*a, *b);
    const std::size_t place = std::min(coupling->place, gears_.size());
    gears_.insert(gears_.begin() + static_cast<std::ptrdiff_t>(place), std::move(coupling->gear));
  }
  return fresh;
}

void World::add_shapes_of(const BodyModel& model) {
  for (const LinkModel& link : model.links) {
    for (std::size_t i = 0; i < link.visuals.size(); i++) {
      const PlacedShape& visual = link.visuals[i];
      std::string name = visual_shape_name(model, link, i);
      if (find_shape(name) != nullptr) continue;
      if (const Result<Shape*> shape = add_shape(std::move(name), visual.shape)) (*shape)->paint(visual);
    }
  }
}

void World::remove_shape(Shape& shape) {
  std::erase_if(shapes_, [&](const std::unique_ptr<Shape>& s) { return s.get() == &shape; });
}

NodeId World::same_shape(const World& other, NodeId shape) const {
  if (&other == this || !other.store_.alive(shape)) return shape;
  const Shape* const found = find_shape(other.store_.name(shape));
  return found == nullptr ? NodeId{} : found->id();
}

void World::order_gears(const std::vector<Gear*>& first) { order(store_, gear_group_, gears_, first); }

void World::order_bodies(const std::vector<Body*>& first) { order(store_, body_group_, bodies_, first); }

void World::order_shapes(const std::vector<Shape*>& first) { order(store_, shape_group_, shapes_, first); }

}  // namespace limber
