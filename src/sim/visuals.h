// Visuals: what the picture is drawn with beside the shapes' materials: the background, the camera, the look. Nothing
// here draws. [sim]
#pragma once

#include "base/vec.h"
#include "params/store.h"
#include "sim/look.h"

namespace limber {

/// The camera, in the seed's terms: the view matrix is T(position)·Rx·Ry·Rz. `eye` and `target` are views of that.
class Camera {
 public:
  static const Table& table();

  Camera(Store& store, NodeId parent);
  NodeId id() const { return id_; }

  /// Where it is, and the point that it looks at, world.
  Vec3 eye() const;
  Vec3 target() const;
  /// Looks from one point at another, upright. Two points in one place turn nothing.
  void look_at(const Vec3& eye, const Vec3& target);

 private:
  /// World axes to the eye's.
  Mat3 turn() const;
  void read_eye(double* out) const;
  void write_eye(const double* in);
  void read_target(double* out) const;
  void write_target(const double* in);

  Store& store_;
  NodeId id_;
};

class Visuals {
 public:
  static const Table& table();

  explicit Visuals(Store& store);
  NodeId id() const { return id_; }
  Camera& camera() { return camera_; }
  const Camera& camera() const { return camera_; }
  const Look& look() const { return look_; }
  /// Back to the defaults.
  void clear();

 private:
  Store& store_;
  NodeId id_;
  Camera camera_;
  Look look_;
};

}  // namespace limber
