// C API: sensors, contacts, rays and spheres.
#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

#include "base/text.h"
#include "script/api/script_context.h"
#include "sim/sensors/sensing.h"
#include "sim/sensors/sensor_list.h"
#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::script {

sim::Sensor* sensor_of(const ScriptContext& c, NodeId id) {
  const Store& store = c.world->store();
  if (!c.alive(id)) return nullptr;
  const PropertyTable* const table = &store.table(id);
  const bool is_sensor =
      std::ranges::any_of(sim::kSensorKinds, [&](sim::SensorKind kind) { return table == &sim::Sensor::table(kind); });
  return is_sensor ? static_cast<sim::Sensor*>(store.object(id)) : nullptr;
}

namespace calls {

namespace {

double word(std::uint32_t v) { return static_cast<double>(v); }

// The body or part that a query ignores; slot -1: none.
sim::Ignored ignored_of(const ScriptContext& c, std::int32_t slot, std::int32_t generation) {
  if (slot < 0) return {};
  const NodeId id = id_of(slot, generation);
  return {object_of<sim::Body>(c, id), object_of<sim::Part>(c, id)};
}

}  // namespace

std::int32_t add_sensor(void* c, std::int32_t slot, std::int32_t generation, const char* kind, std::int32_t kind_length,
                        const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  sim::Part* const part = object_of<sim::Part>(context, id_of(slot, generation));
  if (part == nullptr) return kRemoved;
  const std::optional<sim::SensorKind> wanted = sim::sensor_kind_named(text_of(kind, kind_length));
  if (!wanted) return context.reject("there is no such sensor");
  const Result<sim::Sensor*> sensor = part->body().sensors().add(std::string(text_of(name, length)), *wanted, *part);
  return sensor ? context.set_id((*sensor)->id()) : context.reject(sensor.error());
}

std::int32_t contact(void* c, std::int32_t phase, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const std::span<const sim::ContactEvent> list =
      context.world->sensing().contacts().events(static_cast<sim::ContactPhase>(phase));
  if (index >= static_cast<std::int32_t>(list.size())) return kRejected;
  const sim::ContactEvent& event = list[static_cast<std::size_t>(index)];
  // an earlier callback may have removed one of them
  if (!context.alive(event.part) || !context.alive(event.other)) return kRemoved;
  const double numbers[] = {event.impulse,          event.position.x,
                            event.position.y,       event.position.z,
                            word(event.part.slot),  word(event.part.generation),
                            word(event.other.slot), word(event.other.generation)};
  std::copy(std::begin(numbers), std::end(numbers), context.answer.number);
  return kOk;
}

std::int32_t part_contact(void* c, std::int32_t slot, std::int32_t generation, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  const sim::ContactPoints& points = context.world->sensing().contacts().points();
  const std::span<const sim::PartContact> of_part = points.of(id);
  if (index >= static_cast<std::int32_t>(of_part.size())) return kRejected;
  const sim::ContactPoint& point = points.list()[of_part[static_cast<std::size_t>(index)].point];
  const NodeId other = point.a == id ? point.b : point.a;
  if (!context.alive(other)) return kRemoved;
  const double sign = point.a == id ? 1 : -1;
  double* const numbers = context.answer.number;
  put(numbers, point.position);
  put(numbers + 3, sign * point.normal);
  put(numbers + 6, sign / points.seconds() * point.friction);
  numbers[9] = point.impulse / points.seconds();
  numbers[10] = point.impulse;
  numbers[11] = point.distance;
  return context.set_id(other);
}

std::int32_t zone_event(void* c, std::int32_t enters, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const std::span<const sim::ZoneEvent> list = context.world->sensing().zone_events(enters != 0);
  if (index >= static_cast<std::int32_t>(list.size())) return kRejected;
  const sim::ZoneEvent& event = list[static_cast<std::size_t>(index)];
  if (!context.alive(event.zone) || !context.alive(event.part)) return kRemoved;
  const double numbers[] = {word(event.zone.slot), word(event.zone.generation), word(event.part.slot),
                            word(event.part.generation)};
  std::copy(std::begin(numbers), std::end(numbers), context.answer.number);
  return kOk;
}

std::int32_t ray(void* c, double from_x, double from_y, double from_z, double to_x, double to_y, double to_z,
                 std::int32_t ignore_slot, std::int32_t ignore_generation) {
  ScriptContext& context = context_of(c);
  const Vec3 from(from_x, from_y, from_z);
  const Vec3 offset = Vec3(to_x, to_y, to_z) - from;
  const double length = glm::length(offset);
  if (!(length > 0)) return kRejected;
  const std::optional<sim::RayHit> hit = context.world->sensing().parts().ray(
      from, offset / length, length, ignored_of(context, ignore_slot, ignore_generation));
  if (!hit) return kRejected;
  put(context.answer.number, hit->position);
  put(context.answer.number + 3, hit->normal);
  context.answer.number[6] = hit->distance;
  return context.set_id(hit->part->id());
}

std::int32_t near_parts(void* c, double x, double y, double z, double radius, std::int32_t ignore_slot,
                        std::int32_t ignore_generation) {
  ScriptContext& context = context_of(c);
  context.world->sensing().parts().find_near({x, y, z}, radius, ignored_of(context, ignore_slot, ignore_generation),
                                             context.neighbors.near_parts);
  return static_cast<std::int32_t>(context.neighbors.near_parts.size());
}

std::int32_t near_part(void* c, std::int32_t index) {
  ScriptContext& context = context_of(c);
  if (index < 0 || index >= static_cast<std::int32_t>(context.neighbors.near_parts.size())) return kRejected;
  const sim::NearPart& near = context.neighbors.near_parts[static_cast<std::size_t>(index)];
  context.answer.number[0] = near.distance;
  return context.set_id(near.part->id());
}

}  // namespace calls
}  // namespace limber::script
