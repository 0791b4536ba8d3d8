// urdfdom as the reference of the URDF reader.
#pragma once

#include <string>
#include <vector>

#include "model/urdf/file.h"
#include "model/urdf/tree.h"

namespace limber::model::test {

/// Writes the file that Limber has read as canonical URDF text, parses that with urdfdom, and returns each difference.
std::vector<std::string> urdfdom_differences(const UrdfFile& file, const std::vector<UrdfNode>& tree);

}  // namespace limber::model::test
