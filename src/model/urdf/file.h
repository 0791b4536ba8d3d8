// UrdfFile: the parsed and validated contents of a URDF file, from which a BodyModel is built. The MJCF reader converts
// its files to it; fields that only MJCF files set say so.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"

namespace limber::model {

struct UrdfOrigin {
  Vec3 xyz{0, 0, 0};
  Vec3 rpy{0, 0, 0};           ///< Fixed axes, radians.
  std::optional<Quat> quat{};  ///< Unit; from `quat_xyzw`, where it replaces `rpy`.

  Pose pose() const { return {xyz, quat ? *quat : quat_euler(rpy.x, rpy.y, rpy.z)}; }
};

struct UrdfInertial {
  double mass = 0;
  UrdfOrigin origin;
  bool has_tensor = false;
  Mat3 tensor{0};  ///< As written: along the inertial origin's axes.
};

/// The color and texture of a <material>.
struct UrdfMaterial {
  std::optional<Vec3> color;  ///< r g b 0..1.
  double alpha = 1;
  std::string texture_uri;  ///< Names the image of the texture, which is loaded later; empty: none.

  bool empty() const { return !color && texture_uri.empty(); }
  /// True without a color, and with white, which many files give to textured meshes.
  bool keeps_mesh_colors() const { return !color || *color == Vec3(1); }
};

/// A <visual> or <collision> element. For `shape.kind` mesh, `mesh_uri` names the file, which is loaded later.
struct UrdfShape {
  int line = 0;
  UrdfOrigin origin;
  ShapeModel shape;
  std::string mesh_uri;
  Vec3 mesh_scale{1, 1, 1};
  bool concave = false;  ///< A mesh that is meant to collide as it is, not as its hull.
  /// Of an image with the heights of a heightfield, whose width, length and height are `mesh_scale`; empty: none.
  std::string heights_uri;
  std::string material_name;  ///< Names the material of the file to use if `material` is empty.
  UrdfMaterial material;
};

struct UrdfLink {
  std::string name;
  int line = 0;
  std::optional<UrdfInertial> inertial;
  std::vector<UrdfShape> collisions;
  std::vector<UrdfShape> visuals;
  std::optional<bool> self_collision;  ///< From a <gazebo> element that refers to this link; MJCF: from contact masks.
  /// MJCF: a link without shapes that connects the joints of one body; its small mass isn't reported.
  bool connector = false;
};

struct UrdfMimic {
  int line = 0;
  std::string joint;
  double multiplier = 1;
  double offset = 0;
};

struct UrdfJoint : JointDynamics {
  std::string name;
  int line = 0;
  JointType type = JointType::fixed;
  std::string parent;
  std::string child;
  UrdfOrigin origin;
  Vec3 anchor{0, 0, 0};  ///< MJCF: position of the joint in the child's frame.
  Vec3 axis{1, 0, 0};    ///< Unit.
  bool limited = false;
  double lower = 0;
  double upper = 0;
  std::optional<double> effort;    ///< As written; empty: absent.
  std::optional<double> velocity;  ///< As written; 0 or empty: no limit.
  BallLimitsModel ball;
  SpringModel spring;                     ///< MJCF
  double start = 0;                       ///< MJCF: value at the start, from a keyframe.
  Quat start_rotation = quat_identity();  ///< MJCF: of a spherical joint.
  bool driven = true;                     ///< MJCF: false if the joint has no actuator.
  std::optional<UrdfMimic> mimic;
};

/// A joint that closes a loop: <limber:loop>, or <connect> and <weld> of MJCF.
struct UrdfLoop {
  std::string name;  ///< Empty: made of the links' names.
  int line = 0;
  JointType type = JointType::revolute;
  std::string parent;
  std::string child;
  Pose frame_in_parent;  ///< Of the joint; the loop is closed where both frames coincide.
  Pose frame_in_child;
  Vec3 axis{1, 0, 0};  ///< Unit, in the joint's frame.
  bool limited = false;
  double lower = 0;
  double upper = 0;
  double friction = 0;
};

/// Names a loop in messages: "loop 'name'", or "a loop". [any]
std::string shown_loop(const UrdfLoop& loop);

/// A named frame on a link, such as a <site> of MJCF.
struct UrdfFrame {
  std::string name;
  int link = 0;  ///< Index into UrdfFile::links.
  Pose pose;     ///< In the link's frame.
};

struct UrdfFile {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<UrdfLoop> loops;
  // MJCF only
  std::vector<UrdfFrame> frames;
  std::vector<TendonModel> tendons;             ///< Their links are indices into `links`.
  std::vector<SensorModel> sensors;             ///< `link`: index into `links`; poses are in its frame.
  std::vector<std::pair<int, int>> exclusions;  ///< Pairs of links that don't collide; indices into `links`.
  std::optional<bool> fixed_root;               ///< Unset: a root without mass is fixed to the world.
  Pose root_home;                               ///< Pose of the root link.
  Pose root_start;
};

}  // namespace limber::model
