// Turns a checked URDF tree into a BodyModel: merges fixed children, repairs masses, places links.
// Part of the room's inside: only urdf_import.cpp includes it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "model/problems.h"
#include "model/urdf_file.h"
#include "model/urdf_import.h"
#include "model/urdf_tree.h"

namespace limber {

/// What the steps of building share.
struct UrdfBuild {
  const UrdfFile& file;
  const std::vector<UrdfNode>& tree;
  const ImportOptions& options;
  Problems& problems;
  BodyModel& model;
  std::vector<int> body_link;   ///< By node: index of the model's link that carries it.
  std::vector<Pose> offset;     ///< By node: its frame in that link's frame.
  std::vector<int> body_joint;  ///< By node: index of the model's joint that leads to it; -1: merged or root.

  const UrdfLink& link(std::size_t node) const { return file.links[static_cast<std::size_t>(tree[node].link)]; }
  const UrdfJoint& joint(std::size_t node) const { return file.joints[static_cast<std::size_t>(tree[node].joint)]; }
};

/// Links, merged links, joints with frames and limits; shapes' meshes must be loaded by then. [any]
void build_structure(UrdfBuild& build);
/// Masses, tensors, which root is static (urdf_mass.cpp). [any]
void build_masses(UrdfBuild& build);
/// Mimics, start values, home and start poses, and the lists as the file has them (urdf_pose.cpp). The error names an
/// unknown joint in `options.pose`. [any]
Result<void> build_poses(UrdfBuild& build);
/// Pairs of links that overlap at the home pose; problems of collision shapes: links without any, hulls that fill a
/// hollow (urdf_collisions.cpp). [any]
void build_collisions(UrdfBuild& build);

}  // namespace limber
