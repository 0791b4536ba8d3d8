// BodyModel: the immutable description of a body, as an importer makes it. No simulation here: `sim` builds live
// parts, joints and motors from it, any number of times, and shares its geometry.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace limber {

/// Mass, centre and tensor.
struct Inertial {
  double mass = 0;
  Vec3 center{0, 0, 0};  ///< Centre of mass, in the frame of the link or mesh.
  Mat3 tensor{0};        ///< About the centre of mass, along the frame's axes, kg·m².
};

struct MeshModel;

enum class ShapeKind { plane, sphere, box, cylinder, capsule, cone, mesh, compound };

/// One collision or visual geometry. Which fields count depends on the kind:
/// plane `normal`; sphere `radius`; box `size` (full edges); cylinder, cone `radius height`;
/// capsule `radius height` (without the caps); mesh `mesh`. All centred, along z.
struct ShapeModel {
  ShapeKind kind = ShapeKind::box;
  Vec3 normal{0, 0, 1};
  Vec3 size{1, 1, 1};
  double radius = 0.5;
  double height = 1;
  /// Set for `kind` mesh, and for a mesh that was recognised as a box, sphere or capsule: then `kind` and the
  /// dimensions say what collides, and `mesh` stays for drawing, at `mesh_pose` in the shape's frame.
  std::shared_ptr<const MeshModel> mesh;
  Pose mesh_pose;
};

/// A geometry placed in its link's frame.
struct PlacedShape {
  ShapeModel shape;
  Pose origin;                ///< In the link's frame.
  std::optional<Vec3> color;  ///< r g b 0..1, visuals only.
  double alpha = 1;
};

/// Triangles as they are drawn, and the reduced hull as it collides. Metres, in the mesh's own frame, scale applied.
struct MeshModel {
  std::string name;                 ///< The file's stem, for messages.
  std::vector<Vec3> vertices;       ///< Merged vertices of the drawn mesh.
  std::vector<unsigned> triangles;  ///< Three indices a triangle, counter-clockwise seen from outside.
  std::vector<Vec3> hull;           ///< Hull vertices for contact, reduced (physics.md: 16..64).
  double hull_error = 0;            ///< Distance of the farthest vertex left out from the reduced hull, metres.
  double hull_volume = 0;           ///< Of the whole convex hull, m³.
  /// What the whole hull is, when that is a box, sphere or capsule; in the mesh's frame.
  std::optional<PlacedShape> primitive;
  std::uint64_t content = 0;  ///< hash_bytes of the file.
  bool closed = false;        ///< Watertight: its own volume counts, else the hull's.
  Inertial solid;             ///< At density 1 kg/m³, so that `mass` is the volume in m³.
};

/// One link of the file that moves on its own: fixed children are already merged in, unless kept.
struct LinkModel {
  std::string name;
  Inertial inertial;                    ///< After merging, defaults and repairs; mass 0: static.
  std::vector<PlacedShape> collisions;  ///< Merged children's included, in this link's frame.
  std::vector<PlacedShape> visuals;
  bool self_collision = true;  ///< False: <gazebo><selfCollide> keeps it from colliding with its own body.
  Pose home;                   ///< World pose with all joints at 0 and the root at the origin.
  Pose start;                  ///< World pose as placed at the start (joint values within their limits).
};

enum class JointType { fixed, revolute, continuous, prismatic, planar, floating, spherical };
/// "revolute", as URDF and scenes spell it; and back, by the one naming rule. [any]
std::string_view joint_type_name(JointType type);
std::optional<JointType> joint_type_named(std::string_view name);

struct JointModel {
  std::string name;
  JointType type = JointType::revolute;
  int parent = -1;  ///< Index into BodyModel::links.
  int child = -1;
  Pose frame_in_parent;  ///< Joint frame in the parent link's frame, z = the axis.
  Pose frame_in_child;   ///< The same in the child link's frame (position 0: the child's origin).
  bool limited = false;  ///< false: free; else lower <= upper, rad or m.
  double lower = 0;
  double upper = 0;
  double effort = 10000;  ///< N·m or N, after the default for 0 or absent.
  double velocity = 0;    ///< rad/s or m/s as the file says; 0: as fast as the effort allows.
  double damping = 0;     ///< <dynamics damping>, N·m·s/rad or N·s/m.
  double friction = 0;    ///< <dynamics friction>, Coulomb limit, N·m or N.
  double start = 0;       ///< Joint value that `LinkModel::start` was placed with.
  /// Mimic: value = multiplier * (value of joint `mimic`) + offset; -1: none. The joint it follows follows no other:
  /// chains are resolved by the importer.
  int mimic = -1;
  double mimic_multiplier = 1;
  double mimic_offset = 0;
};

/// A frame that was merged away: a fixed child link, still addressable (`body:link(name)`).
struct MergedLink {
  std::string name;
  int link = -1;  ///< Index of the link that carries it.
  Pose offset;    ///< Its frame in that link's frame.
};

/// Two links whose collision shapes overlap.
struct Overlap {
  int a = 0;  ///< Indices into BodyModel::links, a < b.
  int b = 0;
  double depth = 0;  ///< Penetration depth, m.
};

enum class Severity { note, warning, error };

/// One complaint about the file, with place and cure.
struct Problem {
  int line = 0;  ///< 1-based; 0: no place in the file.
  Severity severity = Severity::warning;
  std::string text;  ///< What is wrong, naming the thing.
  std::string cure;  ///< What to do about it.
};

/// As the file has it, before merging: what `inspect` prints.
struct FileLink {
  std::string name;
  double mass = 0;  ///< As written (0 when there is none).
  Vec3 center{0, 0, 0};
  Mat3 tensor{0};
  int collisions = 0;  ///< Loaded.
  int visuals = 0;
  Pose home;
  Pose start;
};
struct FileJoint {
  std::string name;
  std::string type;
  std::string parent;
  std::string child;
  Vec3 axis{0, 0, 1};  ///< Unit, in the joint's frame.
  bool free = true;    ///< Unlimited.
  double lower = 0;
  double upper = 0;
  double effort = 0;
  double velocity = 0;
  std::string mimic;  ///< The joint that it follows, chains resolved; empty: none.
  double mimic_multiplier = 1;
  double mimic_offset = 0;
};

/// A body, ready to be built. Links and joints in stream order: root first, depth first, joints in file order.
struct BodyModel {
  std::string name;
  std::string file;                ///< Where it came from, for messages.
  std::vector<LinkModel> links;    ///< links[0] is the root.
  std::vector<JointModel> joints;  ///< parent index < child index, always.
  std::vector<MergedLink> merged;
  /// Links without a common joint that overlap with all joints at 0: excluded from collision by default.
  std::vector<Overlap> overlaps;
  std::vector<FileLink> file_links;
  std::vector<FileJoint> file_joints;
  std::vector<Problem> problems;
  std::uint64_t content = 0;  ///< Over the options and all that the files hold: models of one content are the same.
  std::vector<std::string> files;            ///< Every file that was read for it: the URDF and its meshes.
  std::vector<std::uint64_t> file_contents;  ///< hash_bytes of each as it was read; 0: it gave nothing.
  std::vector<std::pair<std::string, std::string>> meshes_found;  ///< As the URDF names them, and their files.
};

}  // namespace limber
