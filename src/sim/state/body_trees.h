// Trees of joints within a body, and the poses of its links. [sim]
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/vec.h"

namespace limber::sim {

class Body;

/// For each part, the index of the root of its tree of joints: the first part that is no joint's child.
std::vector<std::size_t> tree_roots(const Body& body);
/// Moves the parts of one tree rigidly, so that its root is at `pose`; velocities don't change.
void move_tree(const Body& body, std::size_t root, const Pose& pose);
/// Returns the world pose of a link by name, including links that the importer merged into a part.
Result<Pose> link_pose(const Body& body, std::string_view name);

}  // namespace limber::sim
