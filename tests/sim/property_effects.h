// The registry of the effects of properties: one measuring function per property of World, Body, Part, Joint, Motor,
// Gear, Tendon and the kinds of sensors.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace limber::sim::test {

/// Maps class and property to a function that sets the property and measures its effect in the world.
using PropertyEffects = std::map<std::pair<std::string, std::string>, std::function<void()>>;

void add_world_effects(PropertyEffects& effects);
void add_body_effects(PropertyEffects& effects);
void add_part_effects(PropertyEffects& effects);
void add_joint_effects(PropertyEffects& effects);
void add_motor_effects(PropertyEffects& effects);
void add_gear_effects(PropertyEffects& effects);
void add_tendon_effects(PropertyEffects& effects);
void add_sensor_effects(PropertyEffects& effects);

inline const PropertyEffects& all_property_effects() {
  static const PropertyEffects all = [] {
    PropertyEffects effects;
    add_world_effects(effects);
    add_body_effects(effects);
    add_part_effects(effects);
    add_joint_effects(effects);
    add_motor_effects(effects);
    add_gear_effects(effects);
    add_tendon_effects(effects);
    add_sensor_effects(effects);
    return effects;
  }();
  return all;
}

}  // namespace limber::sim::test
