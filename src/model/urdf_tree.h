// Finds the tree in a URDF's links and joints, whatever cycles, second parents and loose ends the file has.
#pragma once

#include <vector>

#include "base/result.h"
#include "model/problems.h"
#include "model/urdf_file.h"

namespace limber {

/// One link in stream order (root first, depth first, joints in file order), and what leads to it.
struct UrdfNode {
  int link = -1;    ///< Index into UrdfFile::links.
  int joint = -1;   ///< Index into UrdfFile::joints of the joint that leads here; -1: the root.
  int parent = -1;  ///< Index of the parent's node; -1: the root.
};

/// The largest tree, the first of equal ones; what is not part of it is said. The error (no link without a parent)
/// starts with a line number and a colon. Time is linear in links and joints for every input. [any]
Result<std::vector<UrdfNode>> find_tree(const UrdfFile& file, Problems& problems);

}  // namespace limber
