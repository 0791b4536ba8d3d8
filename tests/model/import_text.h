// Imports URDF text that a test carries inline.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "model/urdf_import.h"

namespace limber::test {

inline Result<std::shared_ptr<const BodyModel>> try_import(std::string_view text, const ImportOptions& options = {}) {
  static MeshLibrary meshes;
  return import_urdf_text(text, "robot.urdf", options, meshes);
}

/// The body of a text that must hold one; an empty body, and a failure, when it does not.
inline BodyModel import_text(std::string_view text, const ImportOptions& options = {}) {
  const Result<std::shared_ptr<const BodyModel>> model = try_import(text, options);
  if (model) return **model;
  ADD_FAILURE() << model.error();
  return {};
}

/// Whether there is a problem of this severity whose text holds `part`, with a cure and at this line.
inline bool says(const BodyModel& model, Severity severity, std::string_view part, int line) {
  for (const Problem& p : model.problems) {
    if (p.severity == severity && p.text.find(part) != std::string::npos && !p.cure.empty() && p.line == line)
      return true;
  }
  return false;
}

inline std::string all_problems(const BodyModel& model) {
  std::string text;
  for (const Problem& p : model.problems) text += std::to_string(p.line) + ": " + p.text + ". " + p.cure + "\n";
  return text;
}

inline void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& what = "") {
  EXPECT_NEAR(a.x, b.x, tolerance) << what;
  EXPECT_NEAR(a.y, b.y, tolerance) << what;
  EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

/// Angle between two orientations, rad.
inline double angle_between(const Quat& a, const Quat& b) {
  const Quat d = glm::conjugate(a) * b;
  return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

}  // namespace limber::test
