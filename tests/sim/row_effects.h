// The register of what each row does: one measuring function a row of World, Body, Part, Joint, Motor and Gear.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace limber::test {

/// Class and row, and a function that sets the row and measures in the world what it did.
using RowEffects = std::map<std::pair<std::string, std::string>, std::function<void()>>;

void add_world_effects(RowEffects& effects);
void add_body_effects(RowEffects& effects);
void add_part_effects(RowEffects& effects);
void add_joint_effects(RowEffects& effects);
void add_motor_effects(RowEffects& effects);
void add_gear_effects(RowEffects& effects);

inline const RowEffects& row_effects() {
  static const RowEffects all = [] {
    RowEffects effects;
    add_world_effects(effects);
    add_body_effects(effects);
    add_part_effects(effects);
    add_joint_effects(effects);
    add_motor_effects(effects);
    add_gear_effects(effects);
    return effects;
  }();
  return all;
}

}  // namespace limber::test
