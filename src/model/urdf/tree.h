// Finds the kinematic tree of a URDF's links and joints; tolerates cycles, second parents and unconnected links.
#pragma once

#include <vector>

#include "base/result.h"
#include "model/problems.h"
#include "model/urdf/file.h"

namespace limber::model {

/// One link of the tree, in depth-first order from the root (siblings in file order), with its parent.
struct UrdfNode {
  int link = -1;    ///< Index into UrdfFile::links.
  int joint = -1;   ///< Index into UrdfFile::joints of the joint to the parent; -1: this is the root.
  int parent = -1;  ///< Index of the parent's node; -1: this is the root.
};

/// Returns the largest tree (the first of equal ones) and reports links outside of it. The error (there is no root, as
/// every link has a parent) starts with a line number and a colon. Linear in links and joints for any input. [any]
Result<std::vector<UrdfNode>> find_tree(const UrdfFile& file, Problems& problems);

}  // namespace limber::model
