// BodyModel: the immutable description of an articulated body, produced by an importer. It holds no simulation state:
// `sim` creates any number of simulated bodies from one model, and they share its geometry.
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

namespace limber::model {

/// Mass, center of mass and inertia tensor.
struct Inertial {
  double mass = 0;
  Vec3 center{0, 0, 0};  ///< Center of mass, in the frame of the link or mesh.
  Mat3 tensor{0};        ///< About the center of mass, along the frame's axes, kg·m².
};

struct Image;
struct MeshLook;
struct MeshModel;
class Surface;

enum class ShapeKind { plane, sphere, box, cylinder, capsule, cone, mesh, compound, ellipsoid };

/// One collision or visual geometry. The kind decides which fields are used:
/// plane `normal`; sphere `radius`; box `size` (full edges); ellipsoid `size` (full axes); cylinder, cone `radius
/// height`; capsule `radius height` (without the caps); mesh `mesh`; compound none, its children are kept by the Shape
/// of `sim`. All are centered on the origin; their axis is z.
struct ShapeModel {
  ShapeKind kind = ShapeKind::box;
  Vec3 normal{0, 0, 1};
  Vec3 size{1, 1, 1};
  double radius = 0.5;
  double height = 1;
  /// Set for `kind` mesh, and for a mesh that was recognized as a box, sphere or capsule: then `kind` and the
  /// dimensions define the collision shape, and `mesh` is used for drawing only, at `mesh_pose` in the shape's frame.
  std::shared_ptr<const MeshModel> mesh;
  Pose mesh_pose;
  /// Not null, for `kind` mesh: it collides with these triangles of the mesh, not with its hull. Static parts only.
  std::shared_ptr<const Surface> surface;
  bool mesh_colors = true;  ///< False: a color or texture of the model file replaces the mesh's own colors.
  std::shared_ptr<const Image> texture;  ///< Multiplies the color; null: none. Meshes need texture coordinates.
};

/// True if only static parts can have this shape: it has no inside, and thus no mass.
inline bool is_ground(const ShapeModel& shape) { return shape.kind == ShapeKind::plane || shape.surface != nullptr; }

/// A geometry placed in its link's frame.
struct PlacedShape {
  ShapeModel shape;
  Pose origin;                ///< In the link's frame.
  std::optional<Vec3> color;  ///< r g b 0..1, visuals only; replaces the mesh's own colors.
  double alpha = 1;
};

enum class Severity { note, warning, error };

/// A problem in an imported file, with its line and a suggested fix.
struct Problem {
  int line = 0;  ///< 1-based; 0: not tied to a line.
  Severity severity = Severity::warning;
  std::string text;  ///< Describes the problem and names the element.
  std::string fix;   ///< How to fix it.
};

/// A triangle mesh for drawing and its reduced convex hull for collisions, in meters, in the mesh's own frame, with the
/// scale applied.
struct MeshModel {
  std::string name;                 ///< The file's name without its extension, for messages.
  std::vector<Vec3> vertices;       ///< Merged vertices of the drawn mesh.
  std::vector<unsigned> triangles;  ///< Three indices per triangle, counter-clockwise seen from outside.
  std::vector<Vec3> hull;           ///< Vertices of the reduced convex hull, for contacts (reduced_hull()).
  double hull_error = 0;            ///< Largest distance of an omitted vertex from the reduced hull, meters.
  double hull_volume = 0;           ///< Volume of the complete convex hull, m³; with `pieces`: the sum of theirs.
  /// The convex shapes that it collides as, in the mesh's frame: the objects of its file, or those that a concave mesh
  /// is decomposed into (pieces.h). Empty: it collides as its hull, or as its primitive.
  std::vector<PlacedShape> pieces;
  /// The primitive that the complete hull matches (box, sphere or capsule), in the mesh's frame; empty if none, and
  /// with `pieces`.
  std::optional<PlacedShape> primitive;
  std::uint64_t content_hash = 0;        ///< hash_bytes() of the file.
  std::shared_ptr<const MeshLook> look;  ///< Colors and textures of its triangles; null: none.
  bool closed = false;     ///< Watertight: `unit_inertial` uses the mesh's own volume, otherwise that of its hull.
  Inertial unit_inertial;  ///< Mass properties at density 1 kg/m³, so that `mass` is the volume in m³.
  std::vector<Problem> collision_problems;  ///< Reported where it collides, without a line.
};

/// One rigid link. Links attached to it by fixed joints are merged into it, unless ImportOptions::keep_fixed is set.
struct LinkModel {
  std::string name;
  Inertial inertial;                    ///< After merging, defaults and repairs; mass 0: static.
  std::vector<PlacedShape> collisions;  ///< Including those of merged children, in this link's frame.
  std::vector<PlacedShape> visuals;
  bool self_collision = true;  ///< False: <gazebo><selfCollide> disables its collisions with its own body.
  /// World pose with all joints at 0 and the root where the file places it (URDF: at the origin).
  Pose home;
  Pose start;  ///< World pose with all joints at their start values, and the root's start pose.
};

enum class JointType { fixed, revolute, continuous, prismatic, planar, floating, spherical };
/// The name of a joint type in URDF files and scenes, such as "revolute". [any]
std::string_view joint_type_name(JointType type);
/// The joint type with this name, compared by same_name(); empty if there is none. [any]
std::optional<JointType> joint_type_named(std::string_view name);

struct SpringModel {
  double stiffness = 0;  ///< N·m/rad or N/m; 0: there is none.
  double rest = 0;       ///< Joint value at which it is at rest.
  double damping = 0;    ///< N·m·s/rad or N·s/m.
};

/// Limits of the rotation of a spherical joint, rad; none by default.
struct BallLimitsModel {
  double cone = kPi;         ///< Largest angle between the z axes of the joint's two frames; π: free.
  double twist_lower = kPi;  ///< Of the rotation about the axis; above `twist_upper`: free.
  double twist_upper = -kPi;
  double angle = kPi;  ///< Largest angle of the whole rotation; π: free.
};

/// Forces of a joint that depend on its motion only, and the inertia of its rotor.
struct JointDynamics {
  double damping = 0;   ///< N·m·s/rad or N·s/m.
  double friction = 0;  ///< Coulomb limit, N·m or N.
  double armature = 0;  ///< Inertia of the rotor, kg·m² or kg.
};

struct JointModel : JointDynamics {
  std::string name;
  JointType type = JointType::revolute;
  int parent = -1;  ///< Index into BodyModel::links.
  int child = -1;
  Pose frame_in_parent;  ///< Joint frame in the parent link's frame; its z axis is the joint's axis.
  Pose frame_in_child;   ///< Joint frame in the child link's frame; from a URDF file, it is at the child's origin.
  bool limited = false;  ///< False: free; otherwise lower <= upper, rad or m.
  double lower = 0;
  double upper = 0;
  double effort = 10000;  ///< Largest torque or force, N·m or N; the default replaces 0 and absent values.
  double velocity = 0;    ///< Largest speed, rad/s or m/s, from the file; 0: limited by the effort only.
  double start = 0;       ///< Joint value used for `LinkModel::start`.
  BallLimitsModel ball;   ///< Of a spherical joint.
  SpringModel spring;     ///< If not driven; else the gains of the actuator, for the mode spring.
  bool driven = true;     ///< False: no actuator of the file drives it, so its motor starts in mode off.
  /// Index of the joint that this one follows; -1: none. value = mimic_multiplier * (value of joint `mimic`) +
  /// mimic_offset. The followed joint never follows another: the importer resolves chains.
  int mimic = -1;
  double mimic_multiplier = 1;
  double mimic_offset = 0;

  /// True if a servo can hold the joint's value: planar and floating joints have several, mimic joints follow.
  bool takes_servo() const {
    return mimic < 0 && type != JointType::fixed && type != JointType::floating && type != JointType::planar;
  }
};

/// A cable that slides through points on links. It pulls with stiffness·(length - rest) + damping·(speed of the
/// length).
struct TendonModel {
  struct Point {
    int link = 0;  ///< Index into BodyModel::links.
    Vec3 position{0, 0, 0};
  };
  static constexpr std::size_t kMaxPoints = 64;

  std::string name;
  std::vector<Point> points;
  double stiffness = 0;          ///< N/m
  double damping = 0;            ///< N·s/m
  std::optional<double> rest;    ///< m; empty: its length at the start.
  bool pushes = false;           ///< True: a spring that also pushes.
  std::optional<double> radius;  ///< With which it is drawn, m; empty: the default.
};

/// A named frame: that of a link that was merged into its parent because its joint is fixed, or a site of an MJCF file;
/// scripts can address it (`body:link(name)`).
struct MergedLink {
  std::string name;
  int link = -1;      ///< Index of the link it was merged into, or that it is on.
  Pose offset;        ///< Its frame in that link's frame.
  bool site = false;  ///< True for a site.
};

/// A sensor of an MJCF file.
struct SensorModel {
  enum class Kind : std::uint8_t { imu, range_finder, touch };
  std::string name;
  Kind kind = Kind::imu;
  int link = -1;
  Pose pose;          ///< In the link's frame. A range finder looks along z.
  double radius = 0;  ///< Of the region of a touch sensor, m.
  double range = 0;   ///< Of a range finder, m; 0: the default.
};

/// Two links with overlapping collision shapes.
struct Overlap {
  int a = 0;  ///< Indices into BodyModel::links, a < b.
  int b = 0;
  double depth = 0;  ///< Penetration depth of the first pair of shapes found to overlap, m; others may be deeper.
};

/// A link as written in the file, before merging; printed by `limber inspect`.
struct FileLink {
  std::string name;
  double mass = 0;  ///< As written; 0 if absent.
  Vec3 center{0, 0, 0};
  Mat3 tensor{0};
  int collisions = 0;  ///< Number of collision shapes that were loaded.
  int visuals = 0;     ///< Number of visual shapes that were loaded.
  Pose home;
  Pose start;
};
/// A joint as written in the file, before merging; printed by `limber inspect`.
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
  std::string mimic;  ///< Name of the joint that it follows, with chains resolved; empty: none.
  double mimic_multiplier = 1;
  double mimic_offset = 0;
};

/// A complete articulated body. Links and joints are in depth-first order from the root; siblings are in file order.
struct BodyModel {
  std::string name;
  std::string file;                ///< Path of the model file, for messages.
  std::vector<LinkModel> links;    ///< links[0] is the root.
  std::vector<JointModel> joints;  ///< The parent's index is always less than the child's.
  /// Joints that close loops: each connects two links of the tree. Their child is never the root, and their value at
  /// the start is that of the links' start poses; no motor drives them.
  std::vector<JointModel> loops;
  std::vector<TendonModel> tendons;
  std::vector<MergedLink> merged;
  /// Pairs of links without a common joint that overlap with all joints at 0; excluded from collision by default.
  std::vector<Overlap> overlaps;
  std::vector<std::pair<int, int>> exclusions;  ///< Pairs of links that the file excludes from collision, a < b.
  std::vector<SensorModel> sensors;
  std::vector<FileLink> file_links;
  std::vector<FileJoint> file_joints;
  std::vector<Problem> problems;
  std::uint64_t content_hash = 0;  ///< Hash of the options and of all files: models with equal hashes are identical.
  std::vector<std::string> files;  ///< All files that were read: the model file first, then others.
  std::vector<std::uint64_t> file_hashes;  ///< hash_bytes() of each file as it was read; 0: it could not be loaded.
  std::vector<std::pair<std::string, std::string>>
      mesh_paths;  ///< Mesh URIs in the model file and their resolved paths.
};

}  // namespace limber::model
