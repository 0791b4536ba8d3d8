// The second opinion: urdfdom reads what our own pass understood, written anew in a form that it can't stumble over,
// and both must agree.
#pragma once

#include <vector>

#include "model/problems.h"
#include "model/urdf_file.h"
#include "model/urdf_tree.h"

namespace limber {

/// Says every difference between our reading and urdfdom's as an error. Never throws. [any]
void confirm_with_urdfdom(const UrdfFile& file, const std::vector<UrdfNode>& tree, Problems& problems);

}  // namespace limber
