// Imports URDF text given inline in a test.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "model/urdf/import.h"

namespace limber::model::test {

inline Result<std::shared_ptr<const BodyModel>> try_import(std::string_view text, const ImportOptions& options = {}) {
  static MeshLibrary meshes;
  return import_urdf_text(text, "robot.urdf", options, meshes);
}

/// Imports a text that must contain a body; otherwise fails the test and returns an empty body.
inline BodyModel import_text(std::string_view text, const ImportOptions& options = {}) {
  const Result<std::shared_ptr<const BodyModel>> model = try_import(text, options);
  if (model) return **model;
  ADD_FAILURE() << model.error();
  return {};
}

/// True if there is a problem of this severity at this line, with a text that contains `part`, and with a fix.
inline bool has_problem(const BodyModel& model, Severity severity, std::string_view part, int line) {
  for (const Problem& p : model.problems) {
    if (p.severity == severity && p.text.find(part) != std::string::npos && !p.fix.empty() && p.line == line)
      return true;
  }
  return false;
}

inline std::string all_problems(const BodyModel& model) {
  std::string text;
  for (const Problem& p : model.problems) text += std::to_string(p.line) + ": " + p.text + ". " + p.fix + "\n";
  return text;
}

inline void expect_near(const Vec3& a, const Vec3& b, double tolerance, const std::string& label = "") {
  EXPECT_NEAR(a.x, b.x, tolerance) << label;
  EXPECT_NEAR(a.y, b.y, tolerance) << label;
  EXPECT_NEAR(a.z, b.z, tolerance) << label;
}

/// Angle between two orientations, rad.
inline double angle_between(const Quat& a, const Quat& b) {
  const Quat d = glm::conjugate(a) * b;
  return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

}  // namespace limber::model::test
