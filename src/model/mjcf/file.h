// MjcfFile: the parsed and validated contents of an MJCF file, in SI units and radians.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"
#include "model/urdf/file.h"

namespace limber::model {

/// The settings of <compiler>.
struct MjcfCompiler {
  enum class FromGeoms { no, yes, automatic };

  bool degrees = true;
  bool global = false;  ///< Poses are those in the world, not in the parent's frame.
  std::string euler_order = "xyz";
  std::string mesh_folder;
  std::string texture_folder;
  bool strip_path = false;
  bool auto_limits = true;
  FromGeoms inertia_from_geoms = FromGeoms::automatic;
  double first_group = 0;  ///< Geoms of these groups have mass.
  double last_group = 5;
  double bound_mass = 0;
  double bound_inertia = 0;
  bool balance_inertia = false;
  double total_mass = -1;  ///< Above 0: all masses are scaled to this sum.
};

struct MjcfGeom {
  UrdfShape shape;
  std::optional<double> mass;     ///< Empty: from the density.
  double density = 1000;          ///< kg/m³.
  unsigned contact_type = 1;      ///< contype: it touches geoms whose affinity has one of these bits.
  unsigned contact_affinity = 1;  ///< conaffinity
  int group = 0;
};

struct MjcfJoint : JointDynamics {
  std::string name;
  int line = 0;
  JointType type = JointType::revolute;
  Vec3 anchor{0, 0, 0};  ///< In the body's frame.
  Vec3 axis{0, 0, 1};    ///< Unit, in the body's frame.
  bool limited = false;
  double lower = 0;  ///< As MuJoCo counts: `reference` at the home pose.
  double upper = 0;
  double reference = 0;
  double largest_angle = 0;   ///< Of a ball joint; 0: free.
  SpringModel spring;         ///< Its rest is 0 at the home pose.
  SpringModel gains;          ///< Of a position actuator.
  double effort = 0;          ///< Of its actuators; 0: not limited.
  double largest_effort = 0;  ///< Of all actuators together; 0: not limited.
  double velocity = 0;
  bool driven = false;                    ///< An actuator drives it.
  double start = 0;                       ///< Value at the start, 0 at the home pose.
  Quat start_rotation = quat_identity();  ///< Of a ball joint.
  std::optional<UrdfMimic> mimic;
};

struct MjcfSite {
  std::string name;
  Pose pose;          ///< In the body's frame.
  double radius = 0;  ///< Half of its largest size.
};

struct MjcfBody {
  std::string name;
  int line = 0;
  int parent = -1;    ///< Index into MjcfFile::bodies; -1: the world.
  Pose pose;          ///< In the parent's frame.
  Pose start;         ///< Of a free body: its pose at the start.
  bool free = false;  ///< A free joint connects it to the world.
  std::vector<MjcfJoint> joints;
  std::vector<MjcfGeom> geoms;
  std::vector<MjcfSite> sites;
  std::optional<UrdfInertial> declared;  ///< <inertial>
  Inertial inertial;                     ///< From `declared` or the geoms.
};

/// <connect> or <weld>. The loop is closed where both frames coincide.
struct MjcfLoop {
  std::string name;  ///< Empty: it has none.
  int line = 0;
  JointType type = JointType::spherical;  ///< Or fixed.
  int body_1 = 0;                         ///< Index into MjcfFile::bodies.
  int body_2 = 0;
  Pose frame_1;                 ///< In body_1.
  std::optional<Pose> frame_2;  ///< In body_2; empty: that of `frame_1` in the home pose.
};

/// <spatial>
struct MjcfTendon {
  int line = 0;
  TendonModel model;  ///< Its links are indices into MjcfFile::bodies; `rest` empty: the length at the home pose.
};

/// Its link is an index into MjcfFile::bodies, its pose is in that body.
using MjcfSensor = SensorModel;

struct MjcfFile {
  std::string name;
  std::vector<MjcfBody> bodies;  ///< bodies[0] is the world; parents come before their children.
  std::vector<MjcfLoop> loops;
  std::vector<MjcfTendon> tendons;
  std::vector<std::pair<int, int>> exclusions;  ///< <contact><exclude>: indices into `bodies`.
  std::vector<MjcfSensor> sensors;
};

}  // namespace limber::model
