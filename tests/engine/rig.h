// A small world for the engine's tests: two bodies with joints and motors, one of them named "1", and a floor.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/message.h"
#include "engine/commands/message_dispatcher.h"
#include "properties/catalog.h"
#include "support/world_objects.h"

namespace limber::engine::test {

inline Arg arg(double v) { return Arg::of(v); }
inline Arg arg(int v) { return Arg::of(static_cast<double>(v)); }
inline Arg arg(bool v) { return Arg::of(v); }
inline Arg arg(const char* v) { return Arg::of(v); }
inline Arg arg(const std::string& v) { return Arg::of(std::string_view(v)); }
inline Arg arg(Arg v) { return v; }

template <class... A>
Message message(std::string address, A&&... args) {
  return {std::move(address), {arg(std::forward<A>(args))...}};
}

inline model::ShapeModel ball() {
  model::ShapeModel model;
  model.kind = model::ShapeKind::sphere;
  model.radius = 0.05;
  return model;
}

/// "arm": base (static), upper, lower, tip with the revolute joints shoulder and elbow and the prismatic slide.
/// "1": base (static) and tip with the revolute joint shoulder. "floor": one static part of that name.
inline void build_bodies(sim::World& world) {
  model::ShapeModel ground;
  ground.kind = model::ShapeKind::plane;
  sim::Shape& sphere = **world.shapes().add("ball", ball());
  sim::Shape& plane = **world.shapes().add("ground", ground);
  const auto pose = [](double x, double z) { return Pose{{x, 0, z}, quat_identity()}; };
  const auto add_joint = [](sim::Body& body, const char* name, const char* from, const char* to,
                            model::JointType type) {
    sim::Part& child = *body.find_part(to);
    const Vec3 axis = type == model::JointType::prismatic ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    sim::Joint& joint = **body.add_joint(name, *body.find_part(from), child, type, child.pose().position, axis);
    ASSERT_TRUE(body.add_motor(joint).ok());
  };
  sim::Body& arm = **world.add_body("arm");
  ASSERT_TRUE(arm.add_part("base", sphere, 0, pose(0, 1)).ok());
  ASSERT_TRUE(arm.add_part("upper", sphere, 1, pose(0, 1.5)).ok());
  ASSERT_TRUE(arm.add_part("lower", sphere, 1, pose(0, 2)).ok());
  ASSERT_TRUE(arm.add_part("tip", sphere, 1, pose(0, 2.5)).ok());
  add_joint(arm, "shoulder", "base", "upper", model::JointType::revolute);
  add_joint(arm, "elbow", "upper", "lower", model::JointType::revolute);
  add_joint(arm, "slide", "lower", "tip", model::JointType::prismatic);
  sim::Body& one = **world.add_body("1");
  ASSERT_TRUE(one.add_part("base", sphere, 0, pose(3, 1)).ok());
  ASSERT_TRUE(one.add_part("tip", sphere, 1, pose(3, 1.5)).ok());
  add_joint(one, "shoulder", "base", "tip", model::JointType::revolute);
  sim::Body& floor = **world.add_body("floor");
  ASSERT_TRUE(floor.add_part("floor", plane, 0, pose(0, 0)).ok());
  world.flush();
}

/// Store, world and dispatcher as in the engine, with the bodies above.
struct Rig {
  Store store;
  sim::World world{store};
  MessageDispatcher dispatcher{world};

  Rig() { build_bodies(world); }

  template <class... A>
  Outcome send(std::string address, A&&... args) {
    dispatcher.begin_pass();
    return dispatcher.execute(message(std::move(address), std::forward<A>(args)...));
  }

  /// Returns the values of a path, or nothing if there is no such value.
  std::vector<double> read(const std::string& path) const {
    const Result<PropertyRef> ref = find_property(store, path);
    if (!ref || ref->property == nullptr) {
      ADD_FAILURE() << path << " is not a property";
      return {};
    }
    std::vector<double> values(ref->property->width);
    store.get(ref->node, *ref->property, values.data());
    return values;
  }

  /// All persistent and transient values of the world, which a rejected message must not change.
  std::vector<double> everything() const {
    std::vector<double> all(store.persistent_values().begin(), store.persistent_values().end());
    all.insert(all.end(), store.transient_values().begin(), store.transient_values().end());
    return all;
  }
};

}  // namespace limber::engine::test
