// WorldFixture: a world with its store, and helpers for creating bodies, setting properties and running ticks. Gravity
// is zero by default.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/log/log.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "support/world_objects.h"

namespace limber::sim::test {

inline model::ShapeModel sphere_model(double radius) {
  model::ShapeModel m;
  m.kind = model::ShapeKind::sphere;
  m.radius = radius;
  return m;
}
inline model::ShapeModel box_model(const Vec3& size) {
  model::ShapeModel m;
  m.kind = model::ShapeKind::box;
  m.size = size;
  return m;
}
/// A cylinder, capsule or cone along z.
inline model::ShapeModel round_model(model::ShapeKind kind, double radius, double height) {
  model::ShapeModel m;
  m.kind = kind;
  m.radius = radius;
  m.height = height;
  return m;
}
inline model::ShapeModel plane_model(const Vec3& normal = {0, 0, 1}) {
  model::ShapeModel m;
  m.kind = model::ShapeKind::plane;
  m.normal = normal;
  return m;
}

/// Largest joint gap of a body, m.
inline double widest_gap(const Body& body) {
  double max_gap = 0;
  for (const auto& joint : body.joints()) max_gap = std::max(max_gap, joint->gap());
  return max_gap;
}

/// Principal moments of a solid box, kg·m².
inline Vec3 box_inertia(double mass, const Vec3& s) {
  return mass / 12 * Vec3(s.y * s.y + s.z * s.z, s.x * s.x + s.z * s.z, s.x * s.x + s.y * s.y);
}

struct WorldFixture {
  WorldFixture() {
    log_to_stderr(false);
    set(world.id(), "gravity", {0, 0, 0});
  }
  ~WorldFixture() { log_to_stderr(true); }
  WorldFixture(const WorldFixture&) = delete;
  WorldFixture& operator=(const WorldFixture&) = delete;

  void set(NodeId id, std::string_view property, std::vector<double> values) {
    const Result<SetOutcome> outcome = store.set(id, property, values);
    if (!outcome) ADD_FAILURE() << outcome.error();
  }
  std::vector<double> get(NodeId id, std::string_view property) const {
    const Property& r = store.table(id).at(property);
    std::vector<double> out(r.width);
    store.get(id, r, out.data());
    return out;
  }
  double number(NodeId id, std::string_view property) const { return get(id, property)[0]; }
  Vec3 vec(NodeId id, std::string_view property) const {
    const std::vector<double> v = get(id, property);
    return {v[0], v[1], v[2]};
  }
  /// Sets one of the three components of a property.
  void set_one(NodeId id, std::string_view property, int i, double value) {
    std::vector<double> v = get(id, property);
    v[static_cast<std::size_t>(i)] = value;
    set(id, property, v);
  }

  void gravity(const Vec3& g) { set(world.id(), "gravity", {g.x, g.y, g.z}); }
  void substeps(int n) { set(world.id(), "substeps", {static_cast<double>(n)}); }
  void iterations(int n) { set(world.id(), "solver_iterations", {static_cast<double>(n)}); }
  void ticks(int n) {
    for (int i = 0; i < n; i++) world.step();
  }
  /// Length of a substep, s.
  double h() const { return number(world.id(), "timestep") / number(world.id(), "substeps"); }

  Shape& shape(const model::ShapeModel& model) {
    return *world.shapes().add("shape" + std::to_string(count_++), model).value();
  }
  Body& body(const std::string& name) { return *world.add_body(name).value(); }
  Part& part(Body& body, const model::ShapeModel& model, double mass, const Pose& pose = {}) {
    return *body.add_part("part" + std::to_string(count_++), shape(model), mass, pose).value();
  }
  /// A body of a single part.
  Part& add_single_part(const model::ShapeModel& model, double mass, const Pose& pose = {}) {
    return part(body("body" + std::to_string(count_++)), model, mass, pose);
  }
  Part& floor() { return add_single_part(plane_model(), 0); }

  Store store;
  World world{store};

 private:
  int count_ = 0;
};

/// A box on a static ball, connected by a joint through its center with one free axis: 0..2 linear x y z, 3..5
/// angular.
struct OneAxisFixture : WorldFixture {
  static constexpr double kMass = 2;
  static constexpr Vec3 kSize{0.4, 0.6, 0.5};

  explicit OneAxisFixture(int axis)
      : axis(axis),
        robot(body("robot")),
        base(part(robot, sphere_model(0.05), 0)),
        child(part(robot, box_model(kSize), kMass)),
        joint(*robot.add_joint("joint", base, child, model::JointType::floating, Vec3(0), Vec3(0, 0, 1)).value()),
        motor(*robot.add_motor(joint).value()) {
    for (const char* property :
         {"linear_lower_limit", "linear_upper_limit", "angular_lower_limit", "angular_upper_limit"}) {
      set(joint.id(), property, {0, 0, 0});
    }
    set(motor.id(), "mode", {0});
    limits(1, -1);
  }

  /// Returns the name of a property of this axis: "linear_" + name or "angular_" + name.
  std::string prefixed(const std::string& name) const { return (axis < 3 ? "linear_" : "angular_") + name; }
  void limits(double lower, double upper) {
    set_one(joint.id(), prefixed("lower_limit"), axis % 3, lower);
    set_one(joint.id(), prefixed("upper_limit"), axis % 3, upper);
  }
  void set_joint(const std::string& name, double value) { set_one(joint.id(), prefixed(name), axis % 3, value); }
  void set_motor(const std::string& name, double value) {
    const std::string property =
        name == "max_force" ? (axis < 3 ? "max_linear_force" : "max_angular_force") : prefixed(name);
    set_one(motor.id(), property, axis % 3, value);
  }
  /// Mass or moment of inertia for the motion along or about the axis.
  double inertia() const { return axis < 3 ? kMass : box_inertia(kMass, kSize)[axis - 3]; }
  double x() const { return joint.constraint().value(axis); }
  double v() const { return joint.constraint().rate(axis); }
  Vec3 direction() const { return {axis % 3 == 0 ? 1. : 0., axis % 3 == 1 ? 1. : 0., axis % 3 == 2 ? 1. : 0.}; }
  /// Applies a force or torque for the next tick.
  void apply_force(double load) {
    axis < 3 ? child.apply_force(direction() * load) : child.apply_torque(direction() * load);
  }
  void ticks_with_load(int n, double load) {
    for (int i = 0; i < n; i++) {
      apply_force(load);
      world.step();
    }
  }
  void set_rate(double rate) {
    set(child.id(), axis < 3 ? "linear_velocity" : "angular_velocity", as_list(direction() * rate));
  }
  void set_value(double value) {
    const Pose at =
        axis < 3 ? Pose{direction() * value, quat_identity()} : Pose{Vec3(0), quat_axis(direction(), value)};
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

}  // namespace limber::sim::test
