// Stage: a world with its store, and short ways to make bodies, set rows and let time pass. Without gravity until
// asked.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/log.h"
#include "sim/world.h"

namespace limber::test {

inline ShapeModel sphere_model(double radius) {
  ShapeModel m;
  m.kind = ShapeKind::sphere;
  m.radius = radius;
  return m;
}
inline ShapeModel box_model(const Vec3& size) {
  ShapeModel m;
  m.kind = ShapeKind::box;
  m.size = size;
  return m;
}
/// A cylinder, capsule or cone along z.
inline ShapeModel round_model(ShapeKind kind, double radius, double height) {
  ShapeModel m;
  m.kind = kind;
  m.radius = radius;
  m.height = height;
  return m;
}
inline ShapeModel plane_model(const Vec3& normal = {0, 0, 1}) {
  ShapeModel m;
  m.kind = ShapeKind::plane;
  m.normal = normal;
  return m;
}

/// Largest joint gap of a body, m.
inline double widest_gap(const Body& body) {
  double most = 0;
  for (const auto& joint : body.joints()) most = std::max(most, joint->gap());
  return most;
}

/// Principal moments of a solid box, kg·m².
inline Vec3 box_inertia(double mass, const Vec3& s) {
  return mass / 12 * Vec3(s.y * s.y + s.z * s.z, s.x * s.x + s.z * s.z, s.x * s.x + s.y * s.y);
}

struct Stage {
  Stage() {
    log_to_stderr(false);
    set(world.id(), "gravity", {0, 0, 0});
  }
  ~Stage() { log_to_stderr(true); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void set(NodeId id, std::string_view row, std::vector<double> values) {
    const Result<SetOutcome> outcome = store.set(id, row, values);
    if (!outcome) ADD_FAILURE() << outcome.error();
  }
  std::vector<double> get(NodeId id, std::string_view row) const {
    const Row& r = store.table(id).at(row);
    std::vector<double> out(r.width);
    store.get(id, r, out.data());
    return out;
  }
  double number(NodeId id, std::string_view row) const { return get(id, row)[0]; }
  Vec3 vec(NodeId id, std::string_view row) const {
    const std::vector<double> v = get(id, row);
    return {v[0], v[1], v[2]};
  }
  /// One of the three numbers of a row; the others stay.
  void set_one(NodeId id, std::string_view row, int i, double value) {
    std::vector<double> v = get(id, row);
    v[static_cast<std::size_t>(i)] = value;
    set(id, row, v);
  }

  void gravity(const Vec3& g) { set(world.id(), "gravity", {g.x, g.y, g.z}); }
  void substeps(int n) { set(world.id(), "substeps", {static_cast<double>(n)}); }
  void iterations(int n) { set(world.id(), "solver_iterations", {static_cast<double>(n)}); }
  void ticks(int n) {
    for (int i = 0; i < n; i++) world.step();
  }
  /// Length of an internal step.
  double h() const { return number(world.id(), "timestep") / number(world.id(), "substeps"); }

  Shape& shape(const ShapeModel& model) { return *world.add_shape("shape" + std::to_string(made_++), model).value(); }
  Body& body(const std::string& name) { return *world.add_body(name).value(); }
  Part& part(Body& body, const ShapeModel& model, double mass, const Pose& pose = {}) {
    return *body.add_part("part" + std::to_string(made_++), shape(model), mass, pose).value();
  }
  /// A body of a single part.
  Part& lone(const ShapeModel& model, double mass, const Pose& pose = {}) {
    return part(body("body" + std::to_string(made_++)), model, mass, pose);
  }
  Part& floor() { return lone(plane_model(), 0); }

  Store store;
  World world{store};

 private:
  int made_ = 0;
};

/// A box that hangs on a static ball by a joint through its centre, one axis of it free: 0..2 linear x y z, 3..5
/// angular.
struct OneAxis : Stage {
  static constexpr double kMass = 2;
  static constexpr Vec3 kSize{0.4, 0.6, 0.5};

  explicit OneAxis(int axis)
      : axis(axis),
        robot(body("robot")),
        base(part(robot, sphere_model(0.05), 0)),
        child(part(robot, box_model(kSize), kMass)),
        joint(*robot.add_joint("joint", base, child, JointType::floating, Vec3(0), Vec3(0, 0, 1)).value()),
        motor(*robot.add_motor(joint).value()) {
    for (const char* row : {"linear_lower_limit", "linear_upper_limit", "angular_lower_limit", "angular_upper_limit"}) {
      set(joint.id(), row, {0, 0, 0});
    }
    set(motor.id(), "mode", {0});
    limits(1, -1);
  }

  /// "linear_" + name or "angular_" + name.
  std::string side(const std::string& name) const { return (axis < 3 ? "linear_" : "angular_") + name; }
  void limits(double lower, double upper) {
    set_one(joint.id(), side("lower_limit"), axis % 3, lower);
    set_one(joint.id(), side("upper_limit"), axis % 3, upper);
  }
  void of_joint(const std::string& name, double value) { set_one(joint.id(), side(name), axis % 3, value); }
  void of_motor(const std::string& name, double value) {
    const std::string row = name == "max_force" ? (axis < 3 ? "max_linear_force" : "max_angular_force") : side(name);
    set_one(motor.id(), row, axis % 3, value);
  }
  /// Mass or moment of inertia that moves along or about the axis.
  double inertia() const { return axis < 3 ? kMass : box_inertia(kMass, kSize)[axis - 3]; }
  double x() const { return joint.constraint().value(axis); }
  double v() const { return joint.constraint().rate(axis); }
  Vec3 along() const { return {axis % 3 == 0 ? 1. : 0., axis % 3 == 1 ? 1. : 0., axis % 3 == 2 ? 1. : 0.}; }
  /// Force or torque for the coming tick.
  void push(double load) { axis < 3 ? child.apply_force(along() * load) : child.apply_torque(along() * load); }
  void pushed_ticks(int n, double load) {
    for (int i = 0; i < n; i++) {
      push(load);
      world.step();
    }
  }
  void kick(double rate) {
    set(child.id(), axis < 3 ? "linear_velocity" : "angular_velocity", as_list(along() * rate));
  }
  void put(double value) {
    const Pose at = axis < 3 ? Pose{along() * value, quat_identity()} : Pose{Vec3(0), quat_axis(along(), value)};
    child.set_pose(at);
  }
  static std::vector<double> as_list(const Vec3& v) { return {v.x, v.y, v.z}; }

  int axis;
  Body& robot;
  Part& base;
  Part& child;
  Joint& joint;
  Motor& motor;
};

}  // namespace limber::test
