// Fuzzes the URDF importer. Checks that it returns a consistent body or an error.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/target.h"
#include "model/mesh/mass_properties.h"
#include "model/urdf/import.h"

namespace {

bool is_sound(const limber::Pose& pose) {
  return limber::is_finite(pose.position) && std::abs(glm::length(pose.rotation) - 1) < 1e-6;
}

void check_links(const limber::model::BodyModel& model) {
  limber::must(!model.links.empty() && model.links.size() == model.joints.size() + 1);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const limber::model::LinkModel& link = model.links[i];
    limber::must(is_sound(link.home) && is_sound(link.start) && std::isfinite(link.inertial.mass));
    limber::must(i == 0 || link.inertial.mass > 0);
    if (link.inertial.mass > 0) limber::must(limber::model::tensor_error(link.inertial.tensor).empty());
    for (const limber::model::PlacedShape& s : link.collisions) limber::must(is_sound(s.origin));
  }
}

void check_joints(const limber::model::BodyModel& model) {
  const int count = static_cast<int>(model.joints.size());
  for (int i = 0; i < count; ++i) {
    const limber::model::JointModel& j = model.joints[static_cast<std::size_t>(i)];
    limber::must(j.child == i + 1 && j.parent >= 0 && j.parent < j.child);
    limber::must(is_sound(j.frame_in_parent) && is_sound(j.frame_in_child) && std::isfinite(j.start));
    limber::must(j.effort > 0 && j.velocity >= 0 && j.damping >= 0 && j.friction >= 0);
    limber::must(!j.limited || (j.lower <= j.upper && j.start >= j.lower && j.start <= j.upper));
    limber::must(j.mimic < count && (j.mimic < 0 || model.joints[static_cast<std::size_t>(j.mimic)].mimic < 0));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limber::model::MeshLibrary meshes;
  limber::model::ImportOptions options;
  options.keep_fixed = size % 2 == 1;
  if (size % 3 > 0) options.fixed_base = size % 3 == 1;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto model = limber::model::import_urdf_text(text, "/nonexistent/fuzz.urdf", options, meshes);
  if (!model) {
    limber::must(model.error().find("fuzz.urdf") != std::string::npos);
    return 0;
  }
  check_links(**model);
  check_joints(**model);
  for (const limber::model::Problem& p : (*model)->problems) limber::must(!p.text.empty() && !p.fix.empty());
  return 0;
}
