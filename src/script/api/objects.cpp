// C API: names and relations of objects, lists in stream order.
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "script/api/script_context.h"
#include "sim/behavior/behavior_list.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/gears/gear_list.h"
#include "sim/mocap/mocap_list.h"
#include "sim/sensors/sensor_list.h"
#include "sim/shapes/bounds.h"
#include "sim/shapes/shape_list.h"
#include "sim/state/body_trees.h"
#include "sim/state/state_hash.h"
#include "sim/tendons/tendon_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::script::calls {

namespace {

enum Kind : std::int32_t {
  bodies,
  parts,
  joints,
  motors,
  shapes,
  behaviors,
  groups,
  gears,
  sensors,
  tendons,
  fixtures,
  mocap_sources,
  mocap_joints,
  routes
};

// The i-th object of a list, or a null id past the end. For i == -1 the length of the list.
template <class T>
std::int32_t item(ScriptContext& c, std::span<const std::unique_ptr<T>> list, std::int32_t i) {
  if (i < 0) return static_cast<std::int32_t>(list.size());
  const auto at = static_cast<std::size_t>(i);
  return c.set_id(at < list.size() ? list[at]->id() : NodeId{});
}

template <class T>
std::int32_t item(ScriptContext& c, std::span<T* const> list, std::int32_t i) {
  if (i < 0) return static_cast<std::int32_t>(list.size());
  const auto at = static_cast<std::size_t>(i);
  return c.set_id(at < list.size() ? list[at]->id() : NodeId{});
}

std::int32_t list_in_body(ScriptContext& c, const sim::Body& body, std::int32_t kind, std::int32_t i) {
  if (kind == behaviors) return item(c, body.behaviors().list(), i);
  if (kind == sensors) return item(c, body.sensors().list(), i);
  if (kind == tendons) return item<sim::Tendon>(c, c.world->tendons().of(body), i);
  if (kind == parts) return item(c, body.parts(), i);
  if (kind == joints) return item(c, body.joints(), i);
  return item(c, body.motors(), i);
}

std::int32_t list_at(ScriptContext& c, NodeId id, std::int32_t kind, std::int32_t i) {
  if (kind == bodies) return item(c, c.world->bodies(), i);
  if (kind == shapes) return item(c, c.world->shapes().list(), i);
  if (kind == gears) return item(c, c.world->gears().list(), i);
  if (kind == fixtures) return item(c, c.world->visuals().fixtures().list(), i);
  if (kind == routes) return item(c, c.world->behaviors().routes().list(), i);
  if (kind == groups) {
    const std::vector<sim::BehaviorGroup*> all = c.world->behaviors().groups();
    return item<sim::BehaviorGroup>(c, all, i);
  }
  if (kind == mocap_sources) return item(c, c.world->sensing().mocap().list(), i);
  if (kind == mocap_joints) {
    const sim::MocapSource* const source = object_of<sim::MocapSource>(c, id);
    return source == nullptr ? kRemoved : item(c, source->joints(), i);
  }
  if (const sim::Behavior* behavior = behavior_of(c, id)) {
    c.world->behaviors().update_members();
    if (kind == parts) return item(c, behavior->parts(), i);
    if (kind == joints) return item(c, behavior->joints(), i);
    return item(c, behavior->motors(), i);
  }
  const sim::Body* body = object_of<sim::Body>(c, id);
  if (body == nullptr) return kRemoved;
  return list_in_body(c, *body, kind, i);
}

// an object of a list by name
template <class T>
std::int32_t find_among(ScriptContext& c, std::span<T* const> list, std::string_view kind, NodeId of,
                        std::string_view name) {
  for (const T* each : list) {
    if (each->name() == name) return c.set_id(each->id());
  }
  std::vector<std::string_view> names;
  for (const T* each : list) names.push_back(each->name());
  return c.reject(fmt::format("{} has no {} '{}'{}", label_of(c, of), kind, printable(name), name_hint(name, names)));
}

template <class T>
std::int32_t id_or_error(ScriptContext& c, const T* object, std::span<const std::unique_ptr<T>> list,
                         std::string_view kind, std::string_view where, std::string_view name) {
  if (object != nullptr) return c.set_id(object->id());
  std::vector<std::string_view> names;
  for (const auto& each : list) names.push_back(each->name());
  return c.reject(fmt::format("{} no {} '{}'{}", where, kind, printable(name), name_hint(name, names)));
}

template <class T>
std::size_t index_in(std::span<const std::unique_ptr<T>> list, const T* object) {
  const auto at = std::find_if(list.begin(), list.end(), [&](const auto& each) { return each.get() == object; });
  return static_cast<std::size_t>(at - list.begin());
}

std::int32_t find_in_body(ScriptContext& c, const sim::Body& body, std::int32_t kind, std::string_view wanted) {
  if (kind == behaviors) return find_among(c, body.behaviors().list(), "behavior", body.id(), wanted);
  if (kind == tendons) {
    if (const sim::Tendon* tendon = c.world->tendons().find(body, wanted)) return c.set_id(tendon->id());
    return find_among<sim::Tendon>(c, c.world->tendons().of(body), "tendon", body.id(), wanted);
  }
  // create texts only for errors: a look-up in every tick must not allocate
  const auto in_body = [&](auto* thing, auto list, std::string_view kind_name) {
    if (thing != nullptr) return c.set_id(thing->id());
    return id_or_error(c, thing, list, kind_name, fmt::format("body '{}' has", body.name()), wanted);
  };
  if (kind == sensors) return in_body(body.sensors().find(wanted), body.sensors().list(), "sensor");
  if (kind == parts) return in_body(body.find_part(wanted), body.parts(), "part");
  if (kind == joints) return in_body(body.find_joint(wanted), body.joints(), "joint");
  return in_body(body.find_motor(wanted), body.motors(), "motor");
}

// Returns the part of a sensor (0), or the part that it sees (1).
NodeId related_to(const ScriptContext& c, const sim::Sensor& sensor, std::int32_t which) {
  if (which == 0) return sensor.part().id();
  return c.alive(sensor.other()) ? sensor.other() : NodeId{};
}

}  // namespace

std::int32_t structure(void* c) { return static_cast<std::int32_t>(context_of(c).world->store().structure_version()); }

std::int32_t name(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  return context.set_text(context.world->store().name(id));
}

std::int32_t owner(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  // the objects of a body are in its store groups: parts, joints …
  const Store& store = context.world->store();
  if (const sim::MocapJoint* joint = object_of<sim::MocapJoint>(context, id_of(slot, generation)))
    return context.set_id(joint->source().id());
  const NodeId above = store.parent(store.parent(id_of(slot, generation)));
  return context.set_id(object_of<sim::Body>(context, above) == nullptr ? NodeId{} : above);
}

std::int32_t related(void* c, std::int32_t slot, std::int32_t generation, std::int32_t which) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  if (const sim::Joint* joint = object_of<sim::Joint>(context, id)) {
    if (which == 0) return context.set_id(joint->parent().id());
    if (which == 1) return context.set_id(joint->child().id());
    return context.set_id(joint->motor() == nullptr ? NodeId{} : joint->motor()->id());
  }
  if (const sim::Motor* motor = object_of<sim::Motor>(context, id)) return context.set_id(motor->joint().id());
  if (const sim::Gear* gear = object_of<sim::Gear>(context, id)) {
    return context.set_id(which == 0 ? gear->joint_a().id() : gear->joint_b().id());
  }
  if (const sim::Sensor* sensor = sensor_of(context, id)) return context.set_id(related_to(context, *sensor, which));
  if (const sim::Part* part = object_of<sim::Part>(context, id)) {
    return context.set_id(context.alive(part->shape()) ? part->shape() : NodeId{});
  }
  const sim::Body* body = object_of<sim::Body>(context, id);
  return context.set_id(body == nullptr || body->root() == nullptr ? NodeId{} : body->root()->id());
}

std::int32_t list_count(void* c, std::int32_t slot, std::int32_t generation, std::int32_t kind) {
  return list_at(context_of(c), id_of(slot, generation), kind, -1);
}

std::int32_t list_item(void* c, std::int32_t slot, std::int32_t generation, std::int32_t kind, std::int32_t index) {
  return list_at(context_of(c), id_of(slot, generation), kind, index);
}

std::int32_t find(void* c, std::int32_t slot, std::int32_t generation, std::int32_t kind, const char* name,
                  std::int32_t length) {
  ScriptContext& context = context_of(c);
  const sim::World& world = *context.world;
  const std::string_view wanted = text_of(name, length);
  if (kind == bodies) return id_or_error(context, world.find_body(wanted), world.bodies(), "body", "there is", wanted);
  if (kind == shapes)
    return id_or_error(context, world.shapes().find(wanted), world.shapes().list(), "shape", "there is", wanted);
  if (kind == gears)
    return id_or_error(context, world.gears().find(wanted), world.gears().list(), "gear", "there is", wanted);
  if (kind == fixtures) {
    const sim::FixtureList& all = world.visuals().fixtures();
    return id_or_error(context, all.find(wanted), all.list(), "fixture", "there is", wanted);
  }
  if (kind == mocap_sources) {
    const sim::MocapList& all = world.sensing().mocap();
    return id_or_error(context, all.find(wanted), all.list(), "mocap source", "there is", wanted);
  }
  if (kind == routes) {
    const sim::RouteList& all = world.behaviors().routes();
    return id_or_error(context, all.find(wanted), all.list(), "route", "there is", wanted);
  }
  const NodeId id = id_of(slot, generation);
  if (kind == groups) {
    const std::vector<sim::BehaviorGroup*> all = world.behaviors().groups();
    return find_among<sim::BehaviorGroup>(context, all, "group behavior", id, wanted);
  }
  if (const sim::Behavior* behavior = behavior_of(context, id)) {
    if (kind == parts) return find_among(context, behavior->parts(), "part", id, wanted);
    if (kind == joints) return find_among(context, behavior->joints(), "joint", id, wanted);
    return find_among(context, behavior->motors(), "motor", id, wanted);
  }
  const sim::Body* body = object_of<sim::Body>(context, id);
  return body == nullptr ? kRemoved : find_in_body(context, *body, kind, wanted);
}

// Sort order: bodies, each followed by its parts, joints, motors, behaviors, sensors, tendons; then shapes, gears,
// groups, fixtures, sources of motion capture with their joints, routes; removed objects last.
constexpr double kBodyOrder = 0x1p26;
constexpr double kKindOrder = 0x1p23;
constexpr double kWorldOrder = 0x1p52;

std::optional<double> order_in_bodies(const ScriptContext& context, NodeId id) {
  const sim::World& world = *context.world;
  const auto within = [&](const sim::Body& body, double kind, std::size_t at) {
    return kBodyOrder * static_cast<double>(1 + index_in(world.bodies(), &body)) + kKindOrder * kind +
           static_cast<double>(at);
  };
  if (const sim::Body* body = object_of<sim::Body>(context, id)) return within(*body, 0, 0);
  if (const sim::Part* part = object_of<sim::Part>(context, id))
    return within(part->body(), 1, index_in(part->body().parts(), part));
  if (const sim::Joint* joint = object_of<sim::Joint>(context, id))
    return within(joint->body(), 2, index_in(joint->body().joints(), joint));
  if (const sim::Motor* motor = object_of<sim::Motor>(context, id)) {
    const sim::Body& body = motor->joint().body();
    return within(body, 3, index_in(body.motors(), motor));
  }
  if (const sim::Behavior* behavior = behavior_of(context, id)) {
    const std::span<sim::Behavior* const> all = behavior->body().behaviors().list();
    return within(behavior->body(), 4,
                  static_cast<std::size_t>(std::find(all.begin(), all.end(), behavior) - all.begin()));
  }
  if (const sim::Sensor* sensor = sensor_of(context, id))
    return within(sensor->body(), 5, index_in<sim::Sensor>(sensor->body().sensors().list(), sensor));
  if (const sim::Tendon* tendon = object_of<sim::Tendon>(context, id))
    return within(tendon->body(), 6, index_in(world.tendons().list(), tendon));
  return std::nullopt;
}

std::optional<double> order_in_world(const ScriptContext& context, NodeId id) {
  sim::World& world = *context.world;
  const auto within = [](double kind, std::size_t at, double joint = 0) {
    return kWorldOrder * (1 + kind / 16) + kKindOrder * static_cast<double>(at) + joint;
  };
  if (const sim::Shape* shape = object_of<sim::Shape>(context, id))
    return within(0, index_in(world.shapes().list(), shape));
  if (const sim::Gear* gear = object_of<sim::Gear>(context, id)) return within(1, index_in(world.gears().list(), gear));
  if (const sim::BehaviorGroup* group = group_of(context, id)) {
    const std::vector<sim::BehaviorGroup*> all = world.behaviors().groups();
    return within(2, static_cast<std::size_t>(std::find(all.begin(), all.end(), group) - all.begin()));
  }
  if (const sim::Fixture* fixture = object_of<sim::Fixture>(context, id))
    return within(3, index_in(world.visuals().fixtures().list(), fixture));
  if (const sim::MocapSource* source = object_of<sim::MocapSource>(context, id))
    return within(4, index_in(world.sensing().mocap().list(), source));
  if (const sim::MocapJoint* joint = object_of<sim::MocapJoint>(context, id)) {
    const sim::MocapSource& source = joint->source();
    return within(4, index_in(world.sensing().mocap().list(), &source),
                  1 + static_cast<double>(index_in(source.joints(), joint)));
  }
  if (const sim::Route* route = object_of<sim::Route>(context, id))
    return within(5, index_in(world.behaviors().routes().list(), route));
  return std::nullopt;
}

double order(void* c, std::int32_t slot, std::int32_t generation) {
  const ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (const std::optional<double> order = order_in_bodies(context, id)) return *order;
  if (const std::optional<double> order = order_in_world(context, id)) return *order;
  return context.alive(id) ? 0 : kWorldOrder * 1.5 + static_cast<double>(slot);
}

std::int32_t joint_type(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const sim::Joint* joint = object_of<sim::Joint>(context, id_of(slot, generation));
  if (joint == nullptr) return kRemoved;
  return context.set_text(std::string(model::joint_type_name(joint->type())));
}

std::int32_t link_pose(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const sim::Body* body = object_of<sim::Body>(context, id_of(slot, generation));
  if (body == nullptr) return kRemoved;
  const Result<Pose> pose = limber::sim::link_pose(*body, text_of(name, length));
  if (!pose) return context.reject(pose.error());
  const double values[] = {pose->position.x, pose->position.y, pose->position.z, pose->rotation.x,
                           pose->rotation.y, pose->rotation.z, pose->rotation.w};
  std::copy(std::begin(values), std::end(values), context.answer.number);
  return kOk;
}

std::int32_t body_bounds(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const sim::Body* body = object_of<sim::Body>(context, id_of(slot, generation));
  if (body == nullptr) return kRemoved;
  const sim::Bounds bounds = sim::bounds_of(*body);
  if (bounds.empty()) return kRejected;
  for (int axis = 0; axis < 3; axis++) {
    context.answer.number[axis] = bounds.low[axis];
    context.answer.number[axis + 3] = bounds.high[axis];
  }
  return kOk;
}

std::int32_t state_hash(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  if (const sim::Body* body = object_of<sim::Body>(context, id)) {
    return context.set_text(fmt::format("{:016x}", sim::body_hash(*body, hash_bytes("limber"))));
  }
  return context.set_text(fmt::format("{:016x}", context.hash(context.world->state_hash())));
}

}  // namespace limber::script::calls
