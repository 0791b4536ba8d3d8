// Visuals: the view besides the shapes' materials: background, camera and its animations, look, debug overlay, and the
// lighting fixtures, whose beams are drawn; rendering is elsewhere. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "base/vec.h"
#include "properties/store.h"
#include "sim/visuals/appearance.h"
#include "sim/visuals/camera_motion.h"
#include "sim/visuals/overlay.h"

namespace limber::sim {

class FixtureList;

/// The pose of a camera, in the conventions of Camera.
struct CameraView {
  Vec3 position{0};
  Vec3 rotation{0};  ///< Degrees.
  double distance = 0;
};
/// Returns the upright view from one point to another; they must differ. [any]
CameraView view_from_to(const Vec3& eye, const Vec3& target);

/// The camera, with the conventions of ofxDabPhysics: the view matrix is T(position)·Rx·Ry·Rz. `eye` and `target` are
/// derived from it.
class Camera {
 public:
  static const PropertyTable& table();

  Camera(Store& store, NodeId parent);
  NodeId id() const { return id_; }

  /// Position of the eye, and the point that it looks at, in world coordinates.
  Vec3 eye() const;
  Vec3 target() const;
  /// Looks from one point at another, upright. Does nothing if the points coincide.
  void look_at(const Vec3& eye, const Vec3& target);

  /// True if a script or a message has set the pose: it isn't the default one any more.
  bool pose_is_set() const;
  /// Sets the pose and makes it the default one of this world. For the hash, and for reloads, it counts as not set.
  void set_default_pose(const Vec3& eye, const Vec3& target);
  /// True if the pose is that of set_default_pose().
  bool has_framed_pose() const { return default_pose_ && pose() == *default_pose_; }
  /// Bits of the pose's properties: position, rotation and distance.
  static std::uint64_t pose_mask();
  /// Hash of the settings, for the hash of the world.
  std::uint64_t settings_hash() const;

 private:
  using CameraPose = std::array<double, 7>;  // position, rotation, distance

  CameraPose pose() const;
  /// Rotation from world axes to eye axes.
  Mat3 rotation() const;
  void read_eye(double* out) const;
  void write_eye(const double* in);
  void read_target(double* out) const;
  void write_target(const double* in);

  Store& store_;
  NodeId id_;
  std::optional<CameraPose> default_pose_;  // nothing: that of the table
};

class Visuals {
 public:
  static const PropertyTable& table();

  explicit Visuals(World& world);
  ~Visuals();
  Visuals(const Visuals&) = delete;
  Visuals& operator=(const Visuals&) = delete;
  NodeId id() const { return id_; }
  Camera& camera() { return camera_; }
  const Camera& camera() const { return camera_; }
  const Appearance& appearance() const { return appearance_; }
  CameraMoves& camera_moves() { return camera_moves_; }
  Overlay& overlay() { return overlay_; }
  FixtureList& fixtures() const { return *fixtures_; }
  /// Resets all properties to their defaults, ends the animations, and removes the fixtures.
  void clear();

 private:
  Store& store_;
  NodeId id_;
  Camera camera_;
  Appearance appearance_;
  CameraMoves camera_moves_;
  Overlay overlay_;
  std::unique_ptr<FixtureList> fixtures_;
};

}  // namespace limber::sim
