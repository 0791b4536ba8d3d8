// MuJoCo as the reference of the MJCF reader.
#pragma once

#include <string>
#include <vector>

namespace limber::model::test {

struct MujocoComparison {
  std::string rejected;                  ///< The reason why MuJoCo doesn't read the file; empty: it does.
  std::vector<std::string> differences;  ///< Bodies whose pose, mass or inertia differ.
  int bodies = 0;                        ///< Number of compared bodies.
  int masses = 0;                        ///< Number of bodies whose masses were compared.
};

/// Compares home poses, masses and inertias with those of MuJoCo, within 1e-5. Bodies whose mass is that of a mesh are
/// excepted, because MuJoCo 2 integrates meshes in its own way.
MujocoComparison compare_with_mujoco(const std::string& path);

}  // namespace limber::model::test
