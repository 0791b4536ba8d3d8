// Steps that convert a checked URDF tree into a BodyModel: merge fixed links, repair masses, place links, find
// overlaps. Internal to the module: only the urdf_*.cpp files include it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "model/problems.h"
#include "model/urdf/file.h"
#include "model/urdf/import.h"
#include "model/urdf/mesh_loader.h"
#include "model/urdf/tree.h"

namespace limber::model {

/// Inputs and intermediate results shared by the steps.
struct UrdfBuildContext {
  const UrdfFile& file;
  const std::vector<UrdfNode>& tree;
  const ImportOptions& options;
  Problems& problems;
  MeshLoader& meshes;
  BodyModel& model;
  std::vector<int> body_link;   ///< By node: index of the model's link that it is, or was merged into.
  std::vector<Pose> offset;     ///< By node: its frame in that link's frame.
  std::vector<int> body_joint;  ///< By node: index of the model's joint to its parent; -1: merged or root.

  const UrdfLink& link(std::size_t node) const { return file.links[static_cast<std::size_t>(tree[node].link)]; }
  const UrdfJoint& joint(std::size_t node) const { return file.joints[static_cast<std::size_t>(tree[node].joint)]; }
};

/// A rotation that maps +z to a unit axis: identity for +z, half a turn about x for -z. [any]
Quat rotation_to_axis(const Vec3& axis);

inline constexpr double kMaxMarkerMass = 1e-7;  ///< kg
/// True for a link without shapes whose mass is too small to be meant: it only marks a frame. [any]
bool is_marker(const UrdfLink& link);

/// Runs all steps. The error is that of build_poses(). [any]
Result<void> build_body(UrdfBuildContext& build);

/// Creates links, merged links, and joints with frames and limits. The shapes' meshes must be loaded already. [any]
void build_structure(UrdfBuildContext& build);
/// True if the root is fixed to the world, by the options, the file, or because it has no mass (mass.cpp). [any]
bool is_root_fixed(const UrdfBuildContext& build);
/// Sets masses and inertia tensors, and decides if the root is static (mass.cpp). [any]
void build_masses(UrdfBuildContext& build);
/// Resolves mimic joints, sets start values, home and start poses, and fills `file_links` and `file_joints`
/// (pose.cpp). The error names an unknown joint or an invalid value in `options.pose`. [any]
Result<void> build_poses(UrdfBuildContext& build);
/// Adds the joints that close loops: those of the file, and those between closing frames (loops.cpp). The start poses
/// must be set already. [any]
void build_loops(UrdfBuildContext& build);
/// Finds pairs of links that overlap at the home pose, and reports links without collision shapes and hulls that fill
/// hollows of their mesh (collisions.cpp). [any]
void build_collisions(UrdfBuildContext& build);

}  // namespace limber::model
