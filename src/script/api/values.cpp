// C API: properties of classes, reading and writing values, actions.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "script/api/script_context.h"
#include "sim/clock/beat_clock.h"
#include "sim/fixtures/fixture.h"
#include "sim/gears/gear.h"
#include "sim/mocap/mocap_source.h"
#include "sim/routes/route.h"
#include "sim/sensors/sensor.h"
#include "sim/shapes/shape.h"
#include "sim/tendons/tendon.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::script::calls {

namespace {

const PropertyTable& table_at(const ScriptContext& c, std::int32_t table) {
  return *c.world->store().tables()[static_cast<std::size_t>(table)];
}

const Property& property_of(const ScriptContext& c, NodeId id, std::int32_t index) {
  return c.world->store().table(id).property(static_cast<std::uint32_t>(index));
}

std::string range_of(const Property& property) {
  return fmt::format("{}{}{}", range_text(property), property.unit.empty() ? "" : " ", property.unit);
}

std::string values_text(std::span<const double> values) {
  std::string text;
  for (const double v : values) text += (text.empty() ? "" : ", ") + (std::isnan(v) ? "nan" : number_text(v));
  return text;
}

// all writes go through this function
std::int32_t write(ScriptContext& c, NodeId id, const Property& property, std::span<const double> values) {
  if (std::any_of(values.begin(), values.end(), [](double v) { return !std::isfinite(v); })) {
    return c.reject(
        fmt::format("{}: '{}' takes finite numbers, not {}", label_of(c, id), property.name, values_text(values)));
  }
  Store& store = c.world->store();
  // the seed of the command line overrides the scene's
  if (c.options.seed && c.answer.top_level != 0 && id == c.world->id() && property.name == "seed") return kOk;
  const Store::ExplicitSetScope explicit_scope(store, c.answer.top_level != 0);
  const Result<SetOutcome> outcome = store.set(id, property, values);
  if (!outcome) return c.reject(outcome.error());
  if (!outcome->clamped) return kOk;
  c.set_text(fmt::format("{}: '{}' takes {}; {} is outside and was clamped", label_of(c, id), property.name,
                         range_of(property), values_text(values)));
  return kClamped;
}

// index of the own axis of a joint or motor in a property with three numbers; -1: none
int own_index(const ScriptContext& c, NodeId id, const Property& property) {
  const sim::Joint* joint = object_of<sim::Joint>(c, id);
  if (const sim::Motor* motor = object_of<sim::Motor>(c, id)) joint = &motor->joint();
  if (joint == nullptr || joint->own_axis() < 0) return -1;
  const bool is_linear = property.name.find("linear") != std::string::npos;
  return is_linear == (joint->own_axis() < 3) ? joint->own_axis() % 3 : -1;
}

}  // namespace

const LimberView* view(void* c) { return reinterpret_cast<const LimberView*>(&context_of(c).views.store); }

const LimberAnswer* answer(void* c) { return &context_of(c).answer; }

const LimberMassTable* mass_table(void* c) {
  return reinterpret_cast<const LimberMassTable*>(&context_of(c).views.masses);
}

std::int32_t class_table(void* c, std::int32_t which) {
  const PropertyTable* const tables[] = {
      &sim::World::table(),       &sim::Body::table(),       &sim::Part::table(),    &sim::Joint::table(),
      &sim::Motor::table(),       &sim::Shape::table(),      &sim::Visuals::table(), &sim::Camera::table(),
      &sim::Appearance::table(),  &sim::Gear::table(),       &sim::imu_table(),      &sim::range_finder_table(),
      &sim::zone_table(),         &sim::touch_table(),       &sim::Tendon::table(),  &sim::Fixture::table(),
      &sim::MocapSource::table(), &sim::MocapJoint::table(), &sim::Route::table(),   &sim::BeatClock::table()};
  return static_cast<std::int32_t>(context_of(c).world->store().table_number(*tables[which]));
}

std::int32_t property_count(void* c, std::int32_t table) {
  return static_cast<std::int32_t>(table_at(context_of(c), table).properties().size());
}

const LimberProperty* property(void* c, std::int32_t table, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const Property& r = table_at(context, table).property(static_cast<std::uint32_t>(index));
  const auto number = [](auto v) { return static_cast<std::int32_t>(v); };
  context.answer.property = {
      r.name.data(),      number(r.name.size()), number(r.type),          number(r.kind), r.transient,
      r.computed(),       number(r.offset),      number(r.width),         r.own_axis,     r.writable(),
      number(r.min_args), number(r.max_args),    number(r.choices.size())};
  return &context.answer.property;
}

std::int32_t property_choice(void* c, std::int32_t table, std::int32_t index, std::int32_t choice) {
  ScriptContext& context = context_of(c);
  return context.set_text(
      table_at(context, table).property(static_cast<std::uint32_t>(index)).choices[static_cast<std::size_t>(choice)]);
}

std::int32_t get(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  context.world->store().get(id, property_of(context, id, property), context.answer.number);
  return kOk;
}

std::int32_t set1(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property, double x) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  return write(context, id, property_of(context, id, property), {&x, 1});
}

std::int32_t set3(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property, double x, double y,
                  double z) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  const double values[] = {x, y, z};
  return write(context, id, property_of(context, id, property), values);
}

std::int32_t set4(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property, double x, double y,
                  double z, double w) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  const double values[] = {x, y, z, w};
  return write(context, id, property_of(context, id, property), values);
}

std::int32_t set_own(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property, double x) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  const Property& r = property_of(context, id, property);
  const int own = own_index(context, id, r);
  if (own < 0) {
    return context.reject(
        fmt::format("{}: one number for '{}' means the own axis, which this joint does not have "
                    "among these three; give a vec3",
                    label_of(context, id), r.name));
  }
  std::array<double, 4> values{};
  context.world->store().get(id, r, values.data());
  values[static_cast<std::size_t>(own)] = x;
  return write(context, id, r, {values.data(), 3});
}

std::int32_t set_choice(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property, const char* text,
                        std::int32_t length) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  const Property& r = property_of(context, id, property);
  const std::string_view wanted = text_of(text, length);
  for (std::size_t i = 0; i < r.choices.size(); i++) {
    const auto value = static_cast<double>(i);
    if (same_name(r.choices[i], wanted)) return write(context, id, r, {&value, 1});
  }
  return context.reject(fmt::format("{}: '{}' can't be '{}'{}", label_of(context, id), r.name, printable(wanted),
                                    name_hint(wanted, r.choices)));
}

LimberForces* forces(void* c) { return context_of(c).effects.forces.view(); }

void forces_full(void* c) {
  ScriptContext& context = context_of(c);
  if (!context.effects.forces.grow()) context.effects.forces.apply_with_rollback(*context.world);
}

std::int32_t act(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property, const double* numbers,
                 std::int32_t count) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  const Property& r = property_of(context, id, property);
  const std::span<const double> args(numbers, static_cast<std::size_t>(count));
  if (args.size() < r.min_args || args.size() > r.max_args) {
    const std::string takes =
        r.min_args == r.max_args ? fmt::format("{}", r.min_args) : fmt::format("{} or {}", r.min_args, r.max_args);
    return context.reject(fmt::format("{}: '{}' takes {} numbers (a vec3 is three), not {}", label_of(context, id),
                                      r.name, takes, args.size()));
  }
  if (std::any_of(args.begin(), args.end(), [](double v) { return !std::isfinite(v); })) {
    return context.reject(
        fmt::format("{}: '{}' takes finite numbers, not {}", label_of(context, id), r.name, values_text(args)));
  }
  context.effects.forces.apply_with_rollback(*context.world);  // apply earlier forces first to keep the order
  const Result<void> done = r.invoke(context.world->store().object(id), args);
  if (!done) return context.reject(fmt::format("{}: '{}' {}", label_of(context, id), r.name, done.error()));
  return kOk;
}

}  // namespace limber::script::calls
