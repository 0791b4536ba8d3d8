// Cross-check of the URDF reader against urdfdom: the checked file is written as canonical URDF text, parsed by
// urdfdom, and compared.
#pragma once

#include <vector>

#include "model/problems.h"
#include "model/urdf/file.h"
#include "model/urdf/tree.h"

namespace limber {

/// Reports each difference between the checked file and urdfdom's reading as an error. Never throws. [any]
void cross_check_with_urdfdom(const UrdfFile& file, const std::vector<UrdfNode>& tree, Problems& problems);

}  // namespace limber
