// Behaviors controlled by messages: the legacy message, paths, lists, faults; and equal runs have equal results.
#include "engine/behaviors.h"

#include "base/log/log.h"
#include "engine/show.h"

namespace limber::engine::test {
namespace {

constexpr const char* kScene = R"(
sim.gravity = vec3(0, 0, 0)
local shape = sim:add_sphere_shape("ball", 0.1)
for i = 1, 3 do
  local body = sim:add_body("arm" .. i)
  body:add_part("base", shape, { position = vec3(i, 0, 0) })
  body:add_part("tip", shape, { position = vec3(i, 1, 0) })
  if i < 3 then body:add_behavior("random_force", "wind", { parts = "tip" }) end
  body:add_behavior("force", "push", { parts = "base" })
end
sim:add_group_behavior("cohesion", "swarm", { bodies = "arm*", parts = "tip" })
)";

struct Behaviors : testing::Test {
  SceneFile file{kScene};
  Show show{file.path()};
  void SetUp() override { log_to_stderr(false); }
  void TearDown() override { log_to_stderr(true); }

  template <class... A>
  std::vector<std::string> replies_to(std::string address, A&&... args) {
    show.sent_texts();
    show.send(std::move(address), std::forward<A>(args)...);
    show.engine.tick();
    return show.sent_texts();
  }
  double value(const std::string& path, std::size_t i = 0) { return show.read("/physics/body/" + path, i); }
};

using Texts = std::vector<std::string>;

TEST_F(Behaviors, TheLegacyMessageSetsABehaviorInEveryBody) {
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "wind", "maxAmp", 4), Texts{});
  EXPECT_EQ(value("arm1/behavior/wind/max_amp"), 4);
  EXPECT_EQ(value("arm2/behavior/wind/max_amp"), 4);
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "wind", "minDir", -1, 0.5, 2), Texts{});
  EXPECT_EQ(value("arm2/behavior/wind/min_dir", 1), 0.5);
}

TEST_F(Behaviors, TheLegacyMessageSelectsABodyByNameOrPattern) {
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "arm1", "wind", "active", 0), Texts{});
  EXPECT_EQ(value("arm1/behavior/wind/active"), 0);
  EXPECT_EQ(value("arm2/behavior/wind/active"), 1);
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "arm[12]", "w*", "appinterval", 20), Texts{});
  EXPECT_EQ(value("arm2/behavior/wind/app_interval"), 20);
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "*", "push", "amp", "7.5"), Texts{});
  EXPECT_EQ(value("arm3/behavior/push/amp"), 7.5);
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "arm1", "wind", "active", "true"), Texts{});
  EXPECT_EQ(value("arm1/behavior/wind/active"), 1);
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "arm1", "wind", "active", false), Texts{});
  EXPECT_EQ(value("arm1/behavior/wind/active"), 0);
}

TEST_F(Behaviors, GroupMembersAreSetLikeOtherBehaviors) {
  EXPECT_EQ(replies_to("/physics/behavior/parameter", "arm2", "swarm", "amount", -2), Texts{});
  EXPECT_EQ(value("arm2/behavior/swarm/amount"), -2);
  EXPECT_EQ(value("arm1/behavior/swarm/amount"), 1);
  EXPECT_EQ(replies_to("/physics/group/swarm/amount", 3), Texts{});
  for (const char* arm : {"arm1", "arm2", "arm3"}) EXPECT_EQ(value(std::string(arm) + "/behavior/swarm/amount"), 3);
  EXPECT_EQ(replies_to("/physics/group/*/active", 0), Texts{});
  EXPECT_EQ(value("arm3/behavior/swarm/active"), 0);
}

TEST_F(Behaviors, AreSetByPath) {
  EXPECT_EQ(replies_to("/physics/body/arm1/behavior/wind/maxamp", 6), Texts{});
  EXPECT_EQ(value("arm1/behavior/wind/max_amp"), 6);
  EXPECT_EQ(replies_to("/physics/body/arm*/behavior/*/active", 0), Texts{});
  EXPECT_EQ(value("arm3/behavior/push/active"), 0);
  EXPECT_EQ(replies_to("/physics/body/arm1/behavior/push/remove"), Texts{});
  EXPECT_EQ(replies_to("/list/behaviors", "arm1"), (Texts{"/list/behaviors arm1 wind swarm"}));
  EXPECT_EQ(replies_to("/physics/group/swarm/remove"), Texts{});
  EXPECT_EQ(replies_to("/list/groups"), (Texts{"/list/groups "}));
}

TEST_F(Behaviors, AreListed) {
  EXPECT_EQ(replies_to("/list/behaviors", "arm2"), (Texts{"/list/behaviors arm2 wind push swarm"}));
  EXPECT_EQ(replies_to("/list/groups"), (Texts{"/list/groups swarm"}));
  EXPECT_EQ(replies_to("/list/groups", "x"), (Texts{"/error /list/groups takes no arguments"}));
}

TEST_F(Behaviors, PlaceChangesTheirOrder) {
  EXPECT_EQ(replies_to("/physics/body/arm2/behavior/push/place", 1), Texts{});
  EXPECT_EQ(replies_to("/list/behaviors", "arm2"), (Texts{"/list/behaviors arm2 push wind swarm"}));
  EXPECT_EQ(replies_to("/list/behaviors", "arm1"), (Texts{"/list/behaviors arm1 wind push swarm"}));
  EXPECT_EQ(replies_to("/physics/body/*/behavior/push/place", 1), Texts{});
  EXPECT_EQ(replies_to("/list/behaviors", "arm1"), (Texts{"/list/behaviors arm1 push wind swarm"}));
  EXPECT_EQ(replies_to("/physics/group/swarm/place", 1), Texts{});
  EXPECT_EQ(replies_to("/list/behaviors", "arm3"), (Texts{"/list/behaviors arm3 swarm push"}));
  EXPECT_EQ(value("arm3/behavior/push/place"), 2);
  EXPECT_EQ(
      replies_to("/physics/body/arm1/behavior/swarm/place", 3),
      (Texts{
          "/error /physics/body/arm1/behavior/swarm/place behavior 'arm1/swarm': a group's member has no place of its "
          "own; set /physics/group/swarm/place"}));
  // a reset restores the values of the scene
  EXPECT_EQ(replies_to("/transport/reset"), Texts{"/transport/state 0 0 0 1"});
  EXPECT_EQ(replies_to("/list/behaviors", "arm2"), (Texts{"/list/behaviors arm2 wind push swarm"}));
}

TEST_F(Behaviors, AScriptChangesTheirOrderUnlessItFails) {
  const SceneFile scene(std::string(kScene) + R"(
sim:body("arm1"):behavior("push").place = 1
local tries = 0
sim:on_step(function()
  tries = tries + 1
  if tries ~= 3 then return end
  sim:body("arm2"):behavior("push").place = 1
  error("on purpose")
end)
)");
  Show own(scene.path());
  own.ticks(4);
  EXPECT_EQ(own.read("/physics/body/arm1/behavior/push/place"), 1);
  EXPECT_EQ(own.read("/physics/body/arm1/behavior/wind/place"), 2);
  EXPECT_EQ(own.read("/physics/body/arm2/behavior/push/place"), 2) << "the call failed";
}

TEST_F(Behaviors, ErrorsListTheExistingNames) {
  const auto rejection = [&](auto... args) {
    const Texts texts = replies_to("/physics/behavior/parameter", args...);
    const std::string head = "/error /physics/behavior/parameter ";
    return texts.size() == 1 && texts[0].starts_with(head) ? texts[0].substr(head.size()) : "not rejected";
  };
  EXPECT_EQ(rejection("wnid", "amp", 1), "there is no behavior 'wnid'; did you mean 'wind'?");
  EXPECT_EQ(rejection("arm1", "wnid", "amp", 1), "no behavior 'wnid' in 'arm1'; did you mean 'wind'?");
  EXPECT_EQ(rejection("amr1", "wind", "amp", 1), "there is no body 'amr1'; did you mean 'arm1'?");
  EXPECT_EQ(rejection("wind", "maxampp", 1),
            "behavior 'arm2/wind' (random_force) has no parameter 'maxampp'; did you mean 'max_amp'?");
  EXPECT_EQ(rejection("wind", "time", 1),
            "behavior 'arm2/wind' (random_force) has no parameter 'time'; there are: active, place, "
            "min_dir, max_dir, min_amp, max_amp, rand_interval, app_interval");
  EXPECT_EQ(rejection("wind", "minDir", 1, 2), "takes 3 numbers, not 2");
  EXPECT_EQ(rejection("wind", "active", "maybe"), "takes true or false, not 'maybe'");
  EXPECT_EQ(rejection("wind", "maxAmp", std::nan("")), "takes 1 number; nan is not finite");
  EXPECT_EQ(rejection(), "takes a body or none, a behavior, the name of its parameter, and the parameter's value");
  EXPECT_EQ(rejection("wind", 3),
            "takes a body or none, a behavior, the name of its parameter, and the parameter's value");
  EXPECT_EQ(value("arm1/behavior/wind/max_amp"), 10);
}

TEST_F(Behaviors, NamesOfBehaviorsAndBodiesMayBeNumbers) {
  sim::World& world = show.engine.world();
  sim::Body& body = **world.add_body("1");
  ASSERT_TRUE(world.behaviors().add(body, "force", "2").ok());
  EXPECT_EQ(replies_to("/physics/behavior/parameter", 1, "2", "amp", 5), Texts{});
  EXPECT_EQ(value("1/behavior/2/amp"), 5);
  EXPECT_EQ(replies_to("/physics/behavior/parameter", 2, "amp", 6), Texts{});
  EXPECT_EQ(value("1/behavior/2/amp"), 6);
}

TEST_F(Behaviors, AnOverrideSurvivesAReset) {
  replies_to("/physics/behavior/parameter", "arm1", "wind", "maxAmp", 4);
  replies_to("/physics/group/swarm/amount", 3);
  replies_to("/transport/reset");
  show.ticks(1);
  EXPECT_EQ(value("arm1/behavior/wind/max_amp"), 4);
  EXPECT_EQ(value("arm2/behavior/swarm/amount"), 3);
}

/// Raises an error at its second step.
class FailsInSecondStep : public sim::Behavior {
 public:
  void step(double) override {
    if (++steps_ == 2) fail({"the string broke", "behaviors_lua/harp.lua", 12});
  }

 private:
  int steps_ = 0;
};

TEST_F(Behaviors, AFaultIsReportedOnceAndCounted) {
  sim::World& world = show.engine.world();
  ASSERT_TRUE(world.behaviors()
                  .types()
                  .add(sim::BehaviorType::create<FailsInSecondStep>("broken", "Breaks.", sim::BehaviorTargets::any, {}))
                  .ok());
  ASSERT_TRUE(world.behaviors().add(*world.find_body("arm1"), "broken", "harp").ok());
  const std::uint64_t faults = show.engine.faults();
  show.sent_texts();
  show.ticks(5);
  EXPECT_EQ(show.sent_texts(),
            (Texts{"/script/error behaviors_lua/harp.lua 12 the string broke\nof /physics/body/arm1/behavior/harp"}));
  EXPECT_EQ(show.engine.faults(), faults + 1);
}

TEST(EngineBehaviors, TwoRunsAreIdentical) {
  const SceneFile file(kEveryBehavior);
  const auto run = [&](int amount) {
    Show show(file.path());
    show.ticks(20);
    show.send("/physics/group/cohesion/amount", amount);
    show.ticks(100);
    return show.engine.state_hash();
  };
  EXPECT_EQ(run(2), run(2));
  EXPECT_NE(run(2), run(3));
}

TEST(EngineBehaviors, ComputingTimeIsNotInTheHash) {
  const SceneFile file(kEveryBehavior);
  Show show(file.path());
  show.ticks(3);
  const std::uint64_t hash = show.engine.state_hash();
  EXPECT_GT(show.engine.times().behaviors, 0);
  EXPECT_EQ(show.engine.state_hash(), hash);
}

}  // namespace
}  // namespace limber::engine::test
