// Dancer: a rig with a source of motion capture of two or more joints, which are at given places.
#pragma once

#include <initializer_list>
#include <memory>
#include <utility>

#include "behaviors/rig.h"
#include "sim/mocap/mocap_list.h"

namespace limber::sim::test {

struct Dancer : Rig {
  Dancer(const Vec3& first, const Vec3& second) : Dancer(std::initializer_list<Vec3>{first, second}) {}
  /// Each joint is the parent of the next one.
  explicit Dancer(std::initializer_list<Vec3> joints) : source(add_source(joints.size())) {
    place(joints);
    advance(1);
  }

  void place(std::initializer_list<Vec3> joints) {
    Message message{"/p", {}};
    for (const Vec3& at : joints) {
      for (int axis = 0; axis < 3; axis++) message.args.push_back(Arg::of(at[axis]));
    }
    EXPECT_TRUE(world.sensing().mocap().accept(message)->ok());
  }
  /// Sets the rotation of the second joint relative to the first, whose rotation is none.
  void turn(const Quat& q) {
    Message message{"/r", {}};
    for (const double value : {1.0, 0.0, 0.0, 0.0, q.w, q.x, q.y, q.z}) message.args.push_back(Arg::of(value));
    EXPECT_TRUE(world.sensing().mocap().accept(message)->ok());
  }
  /// Advances the time of the world and of the dancer, without physics and behaviors.
  void advance(int ticks) {
    for (int i = 0; i < ticks; i++) {
      world.sensing().mocap().step(world.timestep());
      world.restart_time(world.tick() + 1, world.time() + world.timestep());
    }
  }

  MocapSource& source;

 private:
  MocapSource& add_source(std::size_t count) {
    MocapSetup setup;
    setup.messages = {{"/p", "x y z"}, {"/r", "qw qx qy qz"}};
    for (std::size_t i = 0; i < count; i++) {
      setup.joints.push_back("joint" + std::to_string(i));
      if (i > 0) setup.bones.push_back({"joint" + std::to_string(i - 1), "joint" + std::to_string(i)});
    }
    return **world.sensing().mocap().add("dancer", std::make_shared<const MocapSetup>(std::move(setup)));
  }
};

}  // namespace limber::sim::test
