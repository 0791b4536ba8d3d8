// Checks that an imported body is consistent, for the fuzz targets of the importers.
#pragma once

#include <cmath>

#include "fuzz/target.h"
#include "model/body_model.h"
#include "model/mesh/mass_properties.h"

namespace limber {

inline bool is_sound(const Pose& pose) {
  return is_finite(pose.position) && std::abs(glm::length(pose.rotation) - 1) < 1e-6;
}

inline void check_links(const model::BodyModel& model) {
  must(!model.links.empty() && model.links.size() == model.joints.size() + 1);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const model::LinkModel& link = model.links[i];
    must(is_sound(link.home) && is_sound(link.start) && std::isfinite(link.inertial.mass));
    must(i == 0 || link.inertial.mass > 0);
    if (link.inertial.mass > 0) must(model::tensor_error(link.inertial.tensor).empty());
    for (const model::PlacedShape& s : link.collisions) must(is_sound(s.origin));
  }
}

inline void check_joints(const model::BodyModel& model) {
  const int count = static_cast<int>(model.joints.size());
  for (int i = 0; i < count; ++i) {
    const model::JointModel& j = model.joints[static_cast<std::size_t>(i)];
    must(j.child == i + 1 && j.parent >= 0 && j.parent < j.child);
    must(is_sound(j.frame_in_parent) && is_sound(j.frame_in_child) && std::isfinite(j.start));
    must(j.effort > 0 && j.velocity >= 0 && j.damping >= 0 && j.friction >= 0);
    must(!j.limited || (j.lower <= j.upper && j.start >= j.lower && j.start <= j.upper));
    must(j.mimic < count && (j.mimic < 0 || model.joints[static_cast<std::size_t>(j.mimic)].mimic < 0));
  }
}

inline void check_body(const model::BodyModel& model) {
  check_links(model);
  check_joints(model);
  const int count = static_cast<int>(model.links.size());
  for (const auto& [a, b] : model.exclusions) must(a >= 0 && a < b && b < count);
  for (const model::MergedLink& m : model.merged) must(m.link >= 0 && m.link < count);
  for (const model::Problem& p : model.problems) must(!p.text.empty() && !p.fix.empty());
}

}  // namespace limber
