// Gathered from joints, parts, loads, Bullet's manifolds and behaviours' rows.
#include "sim/overlay.h"

#include <algorithm>
#include <cmath>

#include "sim/behavior_list.h"
#include "sim/joint.h"
#include "sim/part_loads.h"
#include "sim/world.h"

namespace limber {

namespace {

constexpr double kGravity = 9.81;  // m/s²: a weight is one on Earth, whatever the scene's gravity
constexpr double kMostReach = 1;   // m
constexpr double kLeastReach = 0.005;

using Kind = OverlayMark::Kind;

// of a box about half its diagonal
double reach_of(const Part& part) {
  const Vec3 i = part.geometry()->unit_inertia;
  const double reach = std::sqrt(3 * std::max({i.x, i.y, i.z}));
  return std::isfinite(reach) ? std::clamp(reach, kLeastReach, kMostReach) : kMostReach;
}

// an arrow at the small end of a large body is still seen
double arrow_reach(const Part& part) {
  double reach = reach_of(part);
  for (const auto& other : part.body().parts()) {
    if (!other->is_static()) reach = std::max(reach, 0.6 * reach_of(*other));
  }
  return reach;
}

// a force in weights of a part
Vec3 weights(const Vec3& force, double mass) { return force / (std::max(mass, 1e-9) * kGravity); }

OverlayMark mark_of(Kind kind, NodeId id, double reach, const Vec3& at) {
  OverlayMark mark;
  mark.kind = kind;
  mark.slot = id.slot;
  mark.reach = reach;
  mark.at = at;
  return mark;
}

Part* part_of(const btCollisionObject* object) { return static_cast<Part*>(object->getUserPointer()); }

}  // namespace

bool Overlay::on() const {
  static const Row& row = Look::table().at("overlay");
  return world_.store().values(world_.visuals().look().id(), row)[0] != 0;
}

void Overlay::take_loads(const PartLoads& loads) {
  forces_.clear();
  if (!on()) return;
  const double tick = world_.timestep();
  loads.each_waiting([&](const PartLoads::Load& load, const PartLoads::Kick& kick) {
    const Part& part = *load.part;
    const Vec3 force = load.force + kick.impulse / tick;
    if (part.is_static() || force == Vec3(0)) return;
    OverlayMark& mark = forces_.emplace_back(mark_of(Kind::force, part.id(), arrow_reach(part), part.center()));
    mark.vector = weights(force, part.mass());
  });
  // loads wait in the order in which they came, which is another one in each tick
  std::sort(forces_.begin(), forces_.end(), [](const OverlayMark& a, const OverlayMark& b) { return a.slot < b.slot; });
}

void Overlay::add_joint(const Joint& joint, std::vector<OverlayMark>& out) const {
  static const Row* const rows[] = {&Joint::table().at("linear_lower_limit"),
                                    &Joint::table().at("linear_upper_limit"),
                                    &Joint::table().at("angular_lower_limit"),
                                    &Joint::table().at("angular_upper_limit"),
                                    &Joint::table().at("offsets"),
                                    &Joint::table().at("angles")};
  const Store& store = world_.store();
  const Pose frame = joint.parent().pose() * joint.spec().frame_in_parent;
  const double reach =
      std::min(joint.parent().is_static() ? kMostReach : reach_of(joint.parent()), reach_of(joint.child()));
  for (int axis = 0; axis < 6; axis++) {
    if (!joint.is_open(axis)) continue;
    const bool angular = axis >= 3;
    const std::size_t first = angular ? 2 : 0;
    OverlayMark& mark =
        out.emplace_back(mark_of(angular ? Kind::turn : Kind::shift, joint.id(), reach, frame.position));
    mark.axis = static_cast<std::uint8_t>(axis % 3);
    mark.turn = frame.rotation;
    mark.low = store.values(joint.id(), *rows[first])[mark.axis];
    mark.high = store.values(joint.id(), *rows[first + 1])[mark.axis];
    mark.limited = mark.low <= mark.high;
    mark.value = store.values(joint.id(), *rows[angular ? 5 : 4])[mark.axis];
  }
}

void Overlay::add_contacts(std::vector<OverlayMark>& out) const {
  static const Row& substeps = World::table().at("substeps");
  const double step = world_.timestep() / world_.store().values(world_.id(), substeps)[0];
  btDispatcher& dispatcher = *world_.bullet().getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); i++) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    Part* const a = part_of(manifold.getBody0());
    Part* const b = part_of(manifold.getBody1());
    if (a == nullptr || b == nullptr) continue;
    // the normal points to the first; the arrow shows what the one that can move is pushed with
    const bool first = !a->is_static();
    const Part& pushed = first ? *a : *b;
    for (int k = 0; k < manifold.getNumContacts(); k++) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      if (point.getDistance() > 0 && point.getAppliedImpulse() <= 0) continue;
      const Vec3 normal = from_bt(point.m_normalWorldOnB) * (first ? 1.0 : -1.0);
      OverlayMark& mark = out.emplace_back(
          mark_of(Kind::contact, pushed.id(), arrow_reach(pushed), from_bt(point.getPositionWorldOnB())));
      mark.vector = weights(normal * static_cast<double>(point.getAppliedImpulse()) / step, pushed.mass());
    }
  }
}

// each of its points in the world: a row of three metres
void Overlay::add_targets(const Behavior& behavior, std::vector<OverlayMark>& out) const {
  if (!behavior.runs()) return;
  for (const Row& row : behavior.type().table->rows().subspan(kCommonBehaviorRows)) {
    if (row.type != RowType::vec3 || row.unit != "m" || row.kind != RowKind::property) continue;
    const Part* const part = behavior.parts().empty() ? nullptr : behavior.parts().front();
    out.push_back(mark_of(Kind::target, behavior.id(), part == nullptr ? 0.1 : reach_of(*part),
                          vec3_at(world_.store().values(behavior.id(), row))));
  }
}

void Overlay::gather(std::vector<OverlayMark>& out) const {
  out.clear();
  for (const auto& body : world_.bodies()) {
    if (!body->in_world()) continue;
    for (const auto& joint : body->joints()) add_joint(*joint, out);
    for (const auto& part : body->parts()) {
      if (part->is_static()) continue;
      OverlayMark& mark = out.emplace_back(mark_of(Kind::center, part->id(), reach_of(*part), part->center()));
      mark.turn = part->principal_axes();
    }
    for (const Behavior* behavior : body->behaviors()) add_targets(*behavior, out);
  }
  for (const OverlayMark& force : forces_) out.push_back(force);
  add_contacts(out);
}

}  // namespace limber
