// Morphs: exact at both ends, monotonic in between, and interrupted by any controller that sets a property.
#include "engine/presets/morph.h"

#include <cmath>

#include "base/vec.h"
#include "engine/edited.h"
#include "sim/bullet/bullet.h"

namespace limber::engine::test {
namespace {

constexpr double kTick = 1.0 / 60;

constexpr const char* kMorphScene = R"(
sim.gravity = vec3(0, 0, 0)
params { { "wind", 0, min = -10, max = 10 }, { "on", false }, { "way", "in", choices = { "in", "out" } } }
local ball = sim:add_sphere_shape("ball", 0.05)
local one = sim:add_body("one")
one:add_part("tip", ball, { position = vec3(0, 1, 1) })
local two = sim:add_body("two")
two:add_part("tip", ball, { position = vec3(0, -1, 1) })
)";

const std::string kWind = "/scene/wind";
const std::string kFrictionOfOne = "/physics/body/one/part/tip/friction";
const std::string kFrictionOfTwo = "/physics/body/two/part/tip/friction";

// Stores the preset "far" (wind 10, on, out, friction 2.5 of both bodies), then restores the values of the scene.
void store_far(Show& show) {
  show.send(kWind, 10);
  show.send("/scene/on", true);
  show.send("/scene/way", "out");
  show.send(kFrictionOfOne, 2.5);
  show.send(kFrictionOfTwo, 2.5);
  show.send("/preset/store", "far");
  show.send("/preset/store", "one", "/physics/body/one//*");
  show.send("/preset/store", "two", "/physics/body/two//*");
  show.send("/preset/recall", "script");
  show.ticks(1);
}

TEST(Morph, FollowsItsEasingInSimulatedTime) {
  struct Case {
    const char* easing;
    double (*ease)(double);
  };
  constexpr Case kCases[] = {{"linear", [](double t) { return t; }},
                             {"smooth", [](double t) { return 3 * t * t - 2 * t * t * t; }},
                             {"in", [](double t) { return t * t; }},
                             {"out", [](double t) { return 1 - (1 - t) * (1 - t); }}};
  for (const Case& c : kCases) {
    EditedShow edited(kMorphScene);
    Show& show = edited.show();
    store_far(show);
    show.send("/preset/recall", "far", 1, c.easing);
    double last = 0;
    for (int i = 0; i <= 60; i++) {
      show.ticks(1);
      const double wind = show.read(kWind);
      EXPECT_NEAR(wind, 10 * c.ease(std::min(1.0, i / 60.0)), 1e-9) << c.easing << " " << i;
      EXPECT_GE(wind, last);
      last = wind;
      const double fraction = c.ease(i / 60.0);
      // at exactly one half the result depends on rounding
      if (std::abs(fraction - 0.5) > 1e-9) {
        EXPECT_EQ(show.read("/scene/on"), fraction > 0.5 ? 1 : 0) << c.easing << " " << i;
      }
      EXPECT_EQ(show.read("/scene/on"), show.read("/scene/way"));
    }
    show.ticks(1);
    EXPECT_EQ(show.read(kWind), 10);
    EXPECT_EQ(show.read("/preset/progress"), 1);
  }
}

TEST(Morph, UpdatesTheWorld) {
  EditedShow edited(kMorphScene);
  Show& show = edited.show();
  store_far(show);
  show.send("/preset/recall", "far", 1, "linear");
  show.ticks(31);
  EXPECT_NEAR(edited.part("one", "tip").rigid().getFriction(), 1.5, 1e-6);
  show.ticks(40);
  EXPECT_EQ(edited.part("one", "tip").rigid().getFriction(), 2.5);
}

TEST(Morph, PausesWithTime) {
  EditedShow edited(kMorphScene);
  Show& show = edited.show();
  store_far(show);
  show.send("/preset/recall", "far", 2, "linear");
  show.ticks(61);
  EXPECT_NEAR(show.read(kWind), 5, 1e-9);
  EXPECT_NEAR(show.read("/preset/progress"), 0.5, 0.01);
  show.send("/transport/pause");
  show.ticks(40);
  EXPECT_NEAR(show.read(kWind), 5, 1e-9);
  show.send("/transport/play");
  show.ticks(30);
  EXPECT_NEAR(show.read(kWind), 7.5, 1e-9);
  show.send("/preset/stop");
  show.ticks(30);
  EXPECT_NEAR(show.read(kWind), 7.5, 0.1) << "unchanged";
  EXPECT_EQ(show.read("/preset/progress"), 1);
}

TEST(Morph, ASetPropertyLeavesTheMorph) {
  EditedShow edited(std::string(kMorphScene) +
                    "osc:on('/mine', function(v) sim:body('two'):part('tip').friction = v end)\n");
  Show& show = edited.show();
  store_far(show);
  show.send("/preset/recall", "far", 1);
  show.ticks(20);
  show.send(kFrictionOfOne, 0.125);
  show.send("/mine", 0.25);
  show.ticks(60);
  EXPECT_EQ(show.read(kFrictionOfOne), 0.125) << "a message";
  EXPECT_EQ(show.read(kFrictionOfTwo), 0.25) << "a handler of the scene";
  EXPECT_EQ(show.read(kWind), 10) << "the other properties continue";
  // in one datagram: a message after the recall takes precedence
  show.send("/preset/recall", "script");
  show.ticks(1);
  show.link.command_queue.push(
      {{message("/preset/recall", "far", 0.5), message(kFrictionOfOne, 1.75)}, {CommandSource::osc, 0x7f000001, 4000}});
  show.ticks(60);
  EXPECT_EQ(show.read(kFrictionOfOne), 1.75);
  EXPECT_EQ(show.read(kFrictionOfTwo), 2.5);
}

TEST(Morph, CallbacksDoNotInterruptIt) {
  EditedShow edited(
      std::string(kMorphScene) +
      "sim:on_step(function() if params.on then return end sim:body('one'):part('tip').friction = 9 end)\n");
  Show& show = edited.show();
  store_far(show);
  show.send("/preset/recall", "far", 1, "linear");
  show.ticks(20);
  EXPECT_EQ(show.read(kFrictionOfOne), 9) << "it writes later in the tick";
  show.ticks(45);
  EXPECT_EQ(show.read(kFrictionOfOne), 2.5) << "at the end all values are the preset's";
}

TEST(Morph, NewerMorphsTakeOverSharedProperties) {
  EditedShow edited(kMorphScene);
  Show& show = edited.show();
  store_far(show);
  show.send("/preset/recall", "one", 1, "linear");
  show.send("/preset/recall", "two", 2, "linear");
  show.ticks(31);
  EXPECT_NEAR(show.read(kFrictionOfOne), 1.5, 1e-9);
  EXPECT_NEAR(show.read(kFrictionOfTwo), 1.0, 1e-9);
  // a morph of both bodies replaces the two running ones
  show.send("/preset/recall", "script", 0.5, "linear");
  show.ticks(16);
  EXPECT_NEAR(show.read(kFrictionOfOne), 1.0 + 2 * kTick / 2, 0.05);
  show.ticks(100);
  EXPECT_EQ(show.read(kFrictionOfOne), 0.5);
  EXPECT_EQ(show.read(kFrictionOfTwo), 0.5);
}

TEST(Morph, ContinuesAfterAReload) {
  EditedShow edited(kMorphScene);
  Show& show = edited.show();
  store_far(show);
  const NodeId before = edited.part("one", "tip").id();
  show.send("/preset/recall", "far", 1, "linear");
  show.ticks(31);
  // the part of `one` gets another shape, so its body is rebuilt; `two` is removed and added again
  EXPECT_EQ(edited.edit("one:add_part(\"tip\", ball,", "one:add_part(\"tip\", sim:add_sphere_shape(\"big\", 0.1),"),
            SceneReloader::ApplyResult::applied);
  EXPECT_NE(edited.part("one", "tip").id(), before);
  EXPECT_NEAR(show.read(kFrictionOfOne), 1.5, 1e-9);
  show.ticks(15);
  EXPECT_NEAR(show.read(kFrictionOfOne), 2.0, 1e-9);
  const std::string two = edited.text.substr(edited.text.find("local two"));
  EXPECT_EQ(edited.edit(two, ""), SceneReloader::ApplyResult::applied);
  show.ticks(3);
  EXPECT_EQ(edited.save(edited.text + two), SceneReloader::ApplyResult::applied);
  show.ticks(30);
  EXPECT_EQ(show.read(kFrictionOfOne), 2.5);
  EXPECT_EQ(show.read(kFrictionOfTwo), 2.5);
  EXPECT_EQ(show.read(kWind), 10);
}

TEST(Morph, AnEditedLineOverridesIt) {
  EditedShow edited(std::string(kMorphScene) + "one:part('tip').friction = 0.5\n");
  Show& show = edited.show();
  store_far(show);
  show.send("/preset/recall", "far", 1, "linear");
  show.ticks(31);
  EXPECT_EQ(edited.edit("friction = 0.5", "friction = 0.75"), SceneReloader::ApplyResult::applied);
  show.ticks(60);
  EXPECT_EQ(show.read(kFrictionOfOne), 0.75);
  EXPECT_EQ(show.read(kFrictionOfTwo), 2.5);
}

TEST(Morph, InterpolatesRotationsAlongArcs) {
  EditedShow edited(kMorphScene);
  Show& show = edited.show();
  const Vec3 axis = normalized(Vec3(1, 2, -1));
  const std::string part = "/physics/body/one/part/tip";
  const auto move_to = [&](double angle, double x) {
    const Quat q = quat_axis(axis, angle);
    show.send(part + "/rotation", q.x, q.y, q.z, q.w);
    show.send(part + "/position", x, 0, 1);
    show.send(part + "/angular_velocity", 0, 0, 0);
  };
  move_to(2.4, 3);
  show.send("/preset/store", "turned", part, "poses", "velocities");
  move_to(0.2, 1);
  show.send("/transport/pause");
  show.ticks(1);
  show.send("/preset/store", "straight", part, "poses", "velocities");
  show.send("/preset/morph", "straight", "turned", 0.5);
  show.ticks(1);
  const Pose half = edited.part("one", "tip").pose();
  EXPECT_NEAR(std::abs(glm::dot(half.rotation, quat_axis(axis, 1.3))), 1, 1e-12);
  EXPECT_NEAR(half.position.x, 2, 1e-12);
  show.send("/preset/recall", "straight");
  show.send("/transport/play");
  show.send("/preset/recall", "turned", 1, "linear");
  show.ticks(31);
  const Pose on_the_way = edited.part("one", "tip").pose();
  EXPECT_NEAR(std::abs(glm::dot(on_the_way.rotation, quat_axis(axis, 1.3))), 1, 1e-6);
  EXPECT_NEAR(on_the_way.position.x, 2, 1e-6);
}

TEST(Morph, AResetJumpsToItsEnd) {
  EditedShow edited(kMorphScene);
  Show& show = edited.show();
  store_far(show);
  show.send("/preset/recall", "far", 5);
  show.ticks(20);
  show.send("/transport/reset");
  show.ticks(2);
  EXPECT_EQ(show.read(kWind), 10);
  EXPECT_EQ(show.read("/preset/progress"), 1);
}

}  // namespace
}  // namespace limber::engine::test
