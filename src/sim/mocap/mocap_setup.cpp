// MocapSetup: conversion of axes, and the dialects of OSC.
#include "sim/mocap/mocap_setup.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::sim {

namespace {

// Bones of VMC (those of Unity's humanoid) and their parents. A bone that a dancer lacks is skipped.
constexpr std::array<std::pair<const char*, const char*>, 25> kVmcBones{{
    {"root", "Hips"},
    {"Hips", "Spine"},
    {"Spine", "Chest"},
    {"Chest", "UpperChest"},
    {"UpperChest", "Neck"},
    {"Neck", "Head"},
    {"Head", "Jaw"},
    {"Head", "LeftEye"},
    {"Head", "RightEye"},
    {"UpperChest", "LeftShoulder"},
    {"LeftShoulder", "LeftUpperArm"},
    {"LeftUpperArm", "LeftLowerArm"},
    {"LeftLowerArm", "LeftHand"},
    {"UpperChest", "RightShoulder"},
    {"RightShoulder", "RightUpperArm"},
    {"RightUpperArm", "RightLowerArm"},
    {"RightLowerArm", "RightHand"},
    {"Hips", "LeftUpperLeg"},
    {"LeftUpperLeg", "LeftLowerLeg"},
    {"LeftLowerLeg", "LeftFoot"},
    {"LeftFoot", "LeftToes"},
    {"Hips", "RightUpperLeg"},
    {"RightUpperLeg", "RightLowerLeg"},
    {"RightLowerLeg", "RightFoot"},
    {"RightFoot", "RightToes"},
}};
constexpr std::array kVmcFingers{"Thumb", "Index", "Middle", "Ring", "Little"};
constexpr std::array kVmcPhalanges{"Proximal", "Intermediate", "Distal"};

void add_vmc_bones(MocapSetup& setup) {
  for (const auto& [parent, child] : kVmcBones) setup.bones.push_back({parent, child});
  for (const char* side : {"Left", "Right"}) {
    for (const char* finger : kVmcFingers) {
      std::string parent = fmt::format("{}Hand", side);
      for (const char* phalanx : kVmcPhalanges) {
        std::string child = fmt::format("{}{}{}", side, finger, phalanx);
        setup.bones.push_back({parent, child});
        parent = std::move(child);
      }
    }
  }
}

}  // namespace

Vec3 MocapAxes::direction(const Vec3& v) const {
  Vec3 out = v;
  if (up == Up::y) out = {v.x, -v.z, v.y};
  if (up == Up::x) out = {v.y, v.z, v.x};
  if (left_handed) out.y = -out.y;
  return out;
}

// A rotation about an axis; a reflection reverses its sense.
Quat MocapAxes::rotation(const Quat& q) const {
  const Vec3 axis = direction({q.x, q.y, q.z});
  const double sense = left_handed ? -1 : 1;
  return Quat(q.w, sense * axis.x, sense * axis.y, sense * axis.z);
}

bool MocapSetup::operator==(const MocapSetup& other) const {
  const auto content = [](const MocapSetup& s) { return s.clip == nullptr ? 0 : s.clip->content_hash; };
  return axes == other.axes && messages == other.messages && joints == other.joints && bones == other.bones &&
         is_vmc == other.is_vmc && content(*this) == content(other);
}

Result<void> set_mocap_dialect(MocapSetup& setup, const std::string& dialect, const std::string& dancer, bool w_first) {
  if (dialect == "osc") {
    const std::string prefix = dancer.empty() ? "/mocap/joint/" : fmt::format("/mocap/{}/joint/", dancer);
    const char* const world = w_first ? "qw qx qy qz" : "qx qy qz qw";
    const char* const local = w_first ? "lqw lqx lqy lqz" : "lqx lqy lqz lqw";
    setup.messages = {{prefix + "pos_world", "x y z"},    {prefix + "pos", "x y z"},
                      {prefix + "rot_world", world},      {prefix + "rot", world},
                      {prefix + "pos_local", "lx ly lz"}, {prefix + "rot_local", local},
                      {prefix + "visible", "confidence"}};
    for (const char* unused : {"lin_vel", "lin_acc", "rot_vel", "rot_acc", "rot_world_euler", "velocity",
                               "acceleration", "pos_root_zero", "pos2d_world", "pos3d_world"})
      setup.messages.push_back({prefix + unused, ""});
    return {};
  }
  if (dialect == "vmc") {
    setup.is_vmc = true;
    const char* const tracker = "joint x y z qx qy qz qw";
    const char* const bone = "joint lx ly lz lqx lqy lqz lqw";
    setup.messages = {{"/VMC/Ext/Root/Pos", bone},
                      {"/VMC/Ext/Bone/Pos", bone},
                      {"/VMC/Ext/Hmd/Pos", tracker},
                      {"/VMC/Ext/Con/Pos", tracker},
                      {"/VMC/Ext/Tra/Pos", tracker},
                      {"/VMC/Ext/OK", ""},
                      {"/VMC/Ext/T", ""}};
    add_vmc_bones(setup);
    return {};
  }
  if (dialect == "psn") {
    setup.messages = {{"/psn/tracker", "joint x y z qw qx qy qz confidence"}};
    return {};
  }
  return Error{fmt::format("there is no dialect '{}'{}", printable(dialect),
                           name_hint(dialect, std::vector<std::string>{"osc", "psn", "vmc"}))};
}

}  // namespace limber::sim
