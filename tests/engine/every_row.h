// For tests of all properties through all interfaces: one object of each class in the scene "everything", and values.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/everything.h"
#include "properties/catalog.h"
#include "sim/mocap/mocap_source.h"
#include "sim/routes/route.h"
#include "sim/world/world.h"
#include "support/world_objects.h"

namespace limber::engine::test {

/// An object of a class: its path, its names in the legacy message, its expression in Lua.
struct Sample {
  const PropertyTable* table;
  std::string path;
  std::vector<std::string> names;
  std::string lua;
};

inline std::vector<Sample> samples(const Store& store) {
  const std::string arm = "/physics/body/arm";
  return {
      {&sim::World::table(), "/physics/sim", {}, "sim"},
      {&sim::Body::table(), "/physics/body/free", {}, "sim:body('free')"},
      {&sim::Part::table(),
       arm + "/part/part_revolute",
       {"arm", "part_revolute"},
       "sim:body('arm'):part('part_revolute')"},
      {&sim::Joint::table(), arm + "/joint/revolute", {"arm", "revolute"}, "sim:body('arm'):joint('revolute')"},
      {&sim::Motor::table(), arm + "/motor/revolute", {"arm", "revolute"}, "sim:body('arm'):motor('revolute')"},
      {&store.table(find_property(store, arm + "/behavior/wind").value().node),
       arm + "/behavior/wind",
       {},
       "sim:body('arm'):behavior('wind')"},
      {&store.table(find_property(store, "/physics/group/swarm").value().node),
       "/physics/group/swarm",
       {},
       "sim:group_behavior('swarm')"},
      {&sim::imu_table(), arm + "/sensor/imu", {}, "sim:body('arm'):sensor('imu')"},
      {&sim::range_finder_table(), arm + "/sensor/eye", {}, "sim:body('arm'):sensor('eye')"},
      {&sim::zone_table(), arm + "/sensor/zone", {}, "sim:body('arm'):sensor('zone')"},
      {&sim::touch_table(), arm + "/sensor/skin", {}, "sim:body('arm'):sensor('skin')"},
      {&sim::Gear::table(), "/physics/gear/rack", {}, "sim:gear('rack')"},
      {&sim::Tendon::table(), arm + "/tendon/cord", {}, "sim:body('arm'):tendon('cord')"},
      {&sim::MocapSource::table(), "/physics/mocap/dancer", {}, "sim:mocap('dancer')"},
      {&sim::MocapJoint::table(), "/physics/mocap/dancer/joint/hips", {}, "sim:mocap('dancer'):joint('hips')"},
      {&sim::Route::table(), "/physics/route/link", {}, "sim:route('link')"},
      {&store.table(find_property(store, "/scene").value().node), "/scene", {}, "params"},
  };
}

/// A value in the property's range that is not its default.
inline std::vector<double> non_default_value(const Property& property) {
  if (property.type == PropertyType::boolean)
    return {property.name == "paused" || property.initial[0] == 0 ? 1.0 : 0.0};
  if (property.type == PropertyType::flags3) return {1, 0, 1};
  if (property.type == PropertyType::quat) return {0, 0, 0.6, 0.8};
  if (property.type == PropertyType::choice) return {property.max == property.initial[0] ? 0 : property.max};
  if (property.name == "place") return {2};  // of two
  if (property.type == PropertyType::integer) return {property.min + 3};
  std::vector<double> values;
  for (std::uint32_t i = 0; i < property.width; i++) {
    const double v = 0.25 * (i + 1);
    values.push_back(v >= property.min && v <= property.max ? v : property.min + (property.max - property.min) * v);
  }
  return values;
}

/// The value as a scene writes it.
inline std::string lua_literal(const Property& property, const std::vector<double>& v) {
  const auto truth = [](double x) { return x != 0 ? "true" : "false"; };
  switch (property.type) {
    case PropertyType::boolean:
      return truth(v[0]);
    case PropertyType::choice:
      return "\"" + property.choices[static_cast<std::size_t>(v[0])] + "\"";
    case PropertyType::flags3:
      return fmt::format("{{ {}, {}, {} }}", truth(v[0]), truth(v[1]), truth(v[2]));
    case PropertyType::vec3:
      return fmt::format("vec3({}, {}, {})", v[0], v[1], v[2]);
    case PropertyType::quat:
      return fmt::format("quat({}, {}, {}, {})", v[0], v[1], v[2], v[3]);
    default:
      return number_text(v[0]);
  }
}

/// A Lua expression for the numbers of a member, for print and osc:send; the label of a choice.
inline std::string lua_numbers(const Property& property, const std::string& member) {
  switch (property.type) {
    case PropertyType::vec3:
      return fmt::format("{0}.x, {0}.y, {0}.z", member);
    case PropertyType::quat:
      return fmt::format("{0}.x, {0}.y, {0}.z, {0}.w", member);
    case PropertyType::flags3:
      return fmt::format("{0}[1], {0}[2], {0}[3]", member);
    default:
      return member;
  }
}

inline bool is_measure(const Property& property) {
  if (property.name == "place") return false;  // limited by the number of behaviors
  return property.type == PropertyType::number || property.type == PropertyType::integer ||
         property.type == PropertyType::vec3;
}

}  // namespace limber::engine::test
