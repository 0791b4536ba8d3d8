// Overlay: collects marks from joints, parts, force accumulators, Bullet's manifolds and behaviors.
#include "sim/visuals/overlay.h"

#include <algorithm>
#include <cmath>

#include "sim/behavior/behavior_list.h"
#include "sim/bullet/island_world.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/force_accumulators.h"
#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr double kGravity = 9.81;  // m/s²: forces are scaled by the weight on Earth, whatever the scene's gravity
constexpr double kMaxSize = 1;     // m
constexpr double kMinSize = 0.005;

using Kind = OverlayMark::Kind;

// Returns roughly half the diagonal of a part's box, m.
double size_of_part(const Part& part) {
  const Vec3 i = part.geometry()->unit_inertia;
  const double size = std::sqrt(3 * std::max({i.x, i.y, i.z}));
  return std::isfinite(size) ? std::clamp(size, kMinSize, kMaxSize) : kMaxSize;
}

// Returns the size of arrows at a part, m; at a small part of a large body it is larger, so that they remain visible.
double arrow_size(const Part& part) {
  double size = size_of_part(part);
  for (const auto& other : part.body().parts()) {
    if (!other->is_static()) size = std::max(size, 0.6 * size_of_part(*other));
  }
  return size;
}

// Returns a force as a multiple of a part's weight.
Vec3 weights(const Vec3& force, double mass) { return force / (std::max(mass, 1e-9) * kGravity); }

OverlayMark make_mark(Kind kind, NodeId id, double size, const Vec3& position) {
  OverlayMark mark;
  mark.kind = kind;
  mark.slot = id.slot;
  mark.size = size;
  mark.position = position;
  return mark;
}

Part* part_of(const btCollisionObject* object) { return static_cast<Part*>(object->getUserPointer()); }

}  // namespace

bool Overlay::on() const {
  static const Property& property = Appearance::table().at("overlay");
  return world_.store().values(world_.visuals().appearance().id(), property)[0] != 0;
}

void Overlay::capture_forces(const ForceAccumulators& accumulators) {
  forces_.clear();
  if (!on()) return;
  const double tick = world_.timestep();
  accumulators.for_each_pending(
      [&](const ForceAccumulators::Wrench& wrench, const ForceAccumulators::Impulse& impulse) {
        const Part& part = *wrench.part;
        const Vec3 force = wrench.force + impulse.linear / tick;
        if (part.is_static() || force == Vec3(0)) return;
        OverlayMark& mark = forces_.emplace_back(make_mark(Kind::force, part.id(), arrow_size(part), part.center()));
        mark.vector = weights(force, part.mass());
      });
  // pending forces are in the order of their first call, which varies from tick to tick
  std::sort(forces_.begin(), forces_.end(), [](const OverlayMark& a, const OverlayMark& b) { return a.slot < b.slot; });
}

void Overlay::add_joint(const Joint& joint, std::vector<OverlayMark>& out) const {
  static const Property* const properties[] = {&Joint::table().at("linear_lower_limit"),
                                               &Joint::table().at("linear_upper_limit"),
                                               &Joint::table().at("angular_lower_limit"),
                                               &Joint::table().at("angular_upper_limit"),
                                               &Joint::table().at("offsets"),
                                               &Joint::table().at("angles")};
  const Store& store = world_.store();
  const Pose frame = joint.parent().pose() * joint.spec().frame_in_parent;
  const double size =
      std::min(joint.parent().is_static() ? kMaxSize : size_of_part(joint.parent()), size_of_part(joint.child()));
  for (int axis = 0; axis < 6; axis++) {
    if (!joint.is_open(axis)) continue;
    const bool angular = axis >= 3;
    const std::size_t first = angular ? 2 : 0;
    OverlayMark& mark = out.emplace_back(
        make_mark(angular ? Kind::rotation_axis : Kind::translation_axis, joint.id(), size, frame.position));
    mark.axis = static_cast<std::uint8_t>(axis % 3);
    mark.rotation = frame.rotation;
    mark.lower = store.values(joint.id(), *properties[first])[mark.axis];
    mark.upper = store.values(joint.id(), *properties[first + 1])[mark.axis];
    mark.limited = mark.lower <= mark.upper;
    mark.value = store.values(joint.id(), *properties[angular ? 5 : 4])[mark.axis];
  }
}

void Overlay::add_contacts(std::vector<OverlayMark>& out) const {
  static const Property& substeps = World::table().at("substeps");
  const double step = world_.timestep() / world_.store().values(world_.id(), substeps)[0];
  btDispatcher& dispatcher = *world_.bullet().getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); i++) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    Part* const a = part_of(manifold.getBody0());
    Part* const b = part_of(manifold.getBody1());
    if (a == nullptr || b == nullptr) continue;
    // the normal points to the first part; the arrow shows the force on a part that can move
    const bool first = !a->is_static();
    const Part& pushed = first ? *a : *b;
    for (int k = 0; k < manifold.getNumContacts(); k++) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      if (point.getDistance() > 0 && point.getAppliedImpulse() <= 0) continue;
      const Vec3 normal = bullet::from_bt(point.m_normalWorldOnB) * (first ? 1.0 : -1.0);
      OverlayMark& mark = out.emplace_back(
          make_mark(Kind::contact, pushed.id(), arrow_size(pushed), bullet::from_bt(point.getPositionWorldOnB())));
      mark.vector = weights(normal * static_cast<double>(point.getAppliedImpulse()) / step, pushed.mass());
    }
  }
}

// Adds a mark for each parameter of the behavior that is a point: a property of type vec3 in meters.
void Overlay::add_targets(const Behavior& behavior, std::vector<OverlayMark>& out) const {
  if (!behavior.runs()) return;
  for (const Property& property : behavior.type().table->properties().subspan(kCommonBehaviorProperties)) {
    if (property.type != PropertyType::vec3 || property.unit != "m" || property.kind != PropertyKind::setting) continue;
    const Part* const part = behavior.parts().empty() ? nullptr : behavior.parts().front();
    out.push_back(make_mark(Kind::target, behavior.id(), part == nullptr ? 0.1 : size_of_part(*part),
                            vec3_at(world_.store().values(behavior.id(), property))));
  }
}

void Overlay::collect(std::vector<OverlayMark>& out) const {
  out.clear();
  for (const auto& body : world_.bodies()) {
    if (!body->in_world()) continue;
    for (const auto& joint : body->joints()) add_joint(*joint, out);
    for (const auto& part : body->parts()) {
      if (part->is_static()) continue;
      OverlayMark& mark = out.emplace_back(make_mark(Kind::center, part->id(), size_of_part(*part), part->center()));
      mark.rotation = part->principal_axes();
    }
    for (const Behavior* behavior : body->behaviors().list()) add_targets(*behavior, out);
  }
  for (const OverlayMark& force : forces_) out.push_back(force);
  add_contacts(out);
}

}  // namespace limber::sim
