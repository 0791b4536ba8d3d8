// The hash of a world and of its bodies.
#include "sim/state/state_hash.h"

#include <array>

#include "base/hash.h"
#include "properties/values_hash.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/bullet.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/gears/gear_list.h"
#include "sim/mocap/mocap_list.h"
#include "sim/sensors/sensor_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/tendons/tendon_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

void add_vector(NumberHash& numbers, const btVector3& v) { numbers.add(v.x(), v.y(), v.z()); }

void add_motion(NumberHash& numbers, const btRigidBody& rigid) {
  const btTransform& frame = rigid.getWorldTransform();
  for (int i = 0; i < 3; i++) add_vector(numbers, frame.getBasis()[i]);
  add_vector(numbers, frame.getOrigin());
  add_vector(numbers, rigid.getLinearVelocity());
  add_vector(numbers, rigid.getAngularVelocity());
}

// A part without mass is static by default, though the default of the property is dynamic: its share of the node's hash
// is this, which is subtracted, so that a default adds nothing.
std::uint64_t default_motion_hash(const Part& part) {
  static const Property& property = Part::table().at("motion");
  const double motion = part.body().store().values(part.id(), property)[0];
  if (part.mass() > 0 || motion != static_cast<double>(PartMotion::fixed)) return 0;
  return values_hash(Part::table().hashed_persistent().subspan(property.offset, 1), &motion);
}

}  // namespace

std::uint64_t body_hash(const Body& body, std::uint64_t start) {
  const Store& values = body.store();
  NumberHash numbers(hash_bytes(body.name(), start));
  const auto add_node = [&](NodeId id) { numbers.add_word(node_hash(values, id)); };
  add_node(body.id());
  if (body.parts().empty()) {
    std::array<double, 7> pose{};
    put(pose.data(), body.pose().position);
    put(pose.data() + 3, body.pose().rotation);
    numbers.add(pose);
  }
  for (const auto& part : body.parts()) {
    add_motion(numbers, part->rigid());
    numbers.add_word(node_hash(values, part->id()) - default_motion_hash(*part));
  }
  for (const auto& joint : body.joints()) add_node(joint->id());
  for (const auto& motor : body.motors()) add_node(motor->id());
  for (const auto& sensor : body.sensors().list()) add_node(sensor->id());
  for (const Tendon* tendon : body.world().tendons().of(body)) add_node(tendon->id());
  for (const PartPair& pair : body.pairs().list()) {
    numbers.add(static_cast<double>(pair.a), static_cast<double>(pair.b), pair.excluded() ? 1 : 0);
  }
  std::uint64_t hash = numbers.value();
  for (const Behavior* behavior : body.behaviors().list()) hash = behavior->state_hash(hash);
  return hash;
}

std::uint64_t World::state_hash() const {
  std::uint64_t fixed = visuals_->camera().settings_hash();
  for (const NodeId id : {id_, visuals_->id(), visuals_->appearance().id(), behaviors_->clock().id()})
    fixed += fixed_node_hash(store_, id);
  NumberHash numbers(hash_bytes(panic_.on() ? "panic" : "limber") + fixed);
  for (const auto& shape : shapes_->list()) numbers.add_word(persistent_hash(store_, shape->id()));
  for (const auto& gear : gears().list()) numbers.add_word(persistent_hash(store_, gear->id()));
  for (const auto& fixture : visuals_->fixtures().list()) numbers.add_word(node_hash(store_, fixture->id()));
  numbers.add(time(), static_cast<double>(state_.tick), static_cast<double>(seed()));
  std::uint64_t hash = sensing_->mocap().state_hash(numbers.value());
  for (const auto& body : bodies()) hash = body_hash(*body, hash);
  return behaviors_->state_hash(hash);
}

}  // namespace limber::sim
