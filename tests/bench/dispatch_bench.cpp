// Messages per second through the dispatcher, for the different ways to address an object.
#include <benchmark/benchmark.h>

#include <string>

#include "engine/commands/message_dispatcher.h"
#include "support/world_objects.h"

namespace limber {
namespace {

// sixteen arms with six joints, as in the default scene
struct Arms {
  Store store;
  sim::World world{store};
  engine::MessageDispatcher dispatch{world};

  Arms() {
    model::ShapeModel ball;
    ball.kind = model::ShapeKind::sphere;
    ball.radius = 0.05;
    sim::Shape& shape = **world.shapes().add("ball", ball);
    for (int b = 1; b <= 16; b++) {
      sim::Body& body = **world.add_body("arm" + std::to_string(b));
      (void)body.add_part("base", shape, 0, {{1.0 * b, 0, 0}, quat_identity()});
      for (int p = 1; p <= 6; p++) {
        const std::string name = "link_" + std::to_string(p);
        sim::Part& part = **body.add_part(name, shape, 1, {{1.0 * b, 0, 0.3 * p}, quat_identity()});
        const std::string joint = "joint_" + std::to_string(p);
        sim::Part& parent = *body.parts()[static_cast<std::size_t>(p - 1)];
        (void)body.add_motor(
            **body.add_joint(joint, parent, part, model::JointType::revolute, part.pose().position, {0, 1, 0}));
      }
    }
    world.flush();
  }
};

void execute_message(benchmark::State& state, const Message& message) {
  Arms arms;
  for (auto _ : state) {
    engine::Outcome outcome = arms.dispatch.execute(message);
    benchmark::DoNotOptimize(outcome);
    if (outcome.kind != engine::Outcome::Kind::applied) state.SkipWithError(outcome.error.c_str());
  }
  state.SetItemsProcessed(state.iterations());
}

const Arg kBody = Arg::of("arm7");
const Arg kJoint = Arg::of("joint_3");

BENCHMARK_CAPTURE(execute_message, world, Message{"/physics/sim/gravity", {Arg::of(-1.6)}});
BENCHMARK_CAPTURE(execute_message, body_and_part,
                  Message{"/physics/part/mass", {kBody, Arg::of("link_3"), Arg::of(0.3)}});
BENCHMARK_CAPTURE(execute_message, body_and_motor_own_axis,
                  Message{"/physics/motor/angularservoposition", {kBody, kJoint, Arg::of(0.3)}});
BENCHMARK_CAPTURE(execute_message, path,
                  Message{"/physics/body/arm7/motor/joint_3/angular_servo_position", {Arg::of(0.3)}});
BENCHMARK_CAPTURE(execute_message, one_body, Message{"/physics/part/friction", {kBody, Arg::of(0.3)}});
BENCHMARK_CAPTURE(execute_message, all_bodies, Message{"/physics/part/friction", {Arg::of(0.3)}});
BENCHMARK_CAPTURE(execute_message, pattern_path, Message{"/physics/body/arm*/part/link_3/friction", {Arg::of(0.3)}});

}  // namespace
}  // namespace limber
