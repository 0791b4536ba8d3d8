// Imports MJCF text given inline in a test.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "model/import.h"

namespace limber::model::test {

inline Result<std::shared_ptr<const BodyModel>> try_mjcf(const std::string& text, const ImportOptions& options = {}) {
  MeshLibrary meshes;
  return import_model_text(text, "model.xml", options, meshes);
}

/// Imports a text that must contain a body; otherwise fails the test and returns an empty body.
inline BodyModel mjcf(const std::string& text, const ImportOptions& options = {}) {
  const auto model = try_mjcf(text, options);
  if (model) return **model;
  ADD_FAILURE() << model.error();
  return {};
}

/// Imports a fixed base with one child that has these joints.
inline BodyModel jointed(const std::string& joints, const std::string& rest = "", const std::string& compiler = "") {
  return mjcf("<mujoco><compiler " + compiler +
              "/><worldbody><body name='base'><geom size='.1'/><body name='arm' pos='0 0 1'>" + joints +
              "<geom type='box' size='.1 .2 .3'/></body></body></worldbody>" + rest + "</mujoco>");
}

}  // namespace limber::model::test
