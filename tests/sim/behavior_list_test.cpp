// The behavior list: order, attaching and its errors, removing, copies, removed bodies.
#include "sim/behavior/behavior_list.h"

#include "sim/behavior_rig.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(BehaviorList, StepsInOrderOfCreationAcrossBodiesAndGroups) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  s.probe(b, "one");
  s.group("flock");
  s.probe(a, "two");
  s.ticks(1);
  BehaviorRig::consume_calls();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step b/one", "step a/flock", "step b/flock", "step a/two"}));
}

TEST(BehaviorList, ErrorsSuggestExistingNames) {
  BehaviorRig s;
  Body& body = s.chain("arm", {"base", "tip"});
  s.probe(body, "p");
  EXPECT_EQ(s.add_error(body, "prob", "q"), "there is no behavior type 'prob'; did you mean 'probe'?");
  EXPECT_EQ(s.add_error(body, "probe_group", "q"),
            "'probe_group' acts on several bodies: attach it with sim:add_group_behavior");
  EXPECT_EQ(s.add_error(body, "probe", "p"), "body 'arm' has a behavior 'p' already; names are unique");
  EXPECT_EQ(s.add_error(body, "probe", "q", on_parts({"tipp"})), "body 'arm' has no part 'tipp'; did you mean 'tip'?");
  BehaviorSetup setup;
  setup.joints = Selection({"to_tpi"});
  EXPECT_EQ(s.add_error(body, "probe", "q", setup), "body 'arm' has no joint 'to_tpi'; did you mean 'to_tip'?");
  setup = {};
  setup.motors = Selection({"base"});
  EXPECT_EQ(s.add_error(body, "probe", "q", setup), "body 'arm' has no motor 'base'; there are: to_tip");
  EXPECT_NE(s.add_error(body, "probe", ""), "");
  // a rejected behavior leaves nothing behind
  EXPECT_EQ(names_in(body.behaviors().list()), (Words{"p"}));
  EXPECT_EQ(s.store.children(s.store.child(body.id(), "behavior")).size(), 1U);
  EXPECT_EQ(s.add_group_error("probe", "g"), "'probe' acts on one body: attach it with body:add_behavior");
}

TEST(BehaviorList, WarnsAboutUnusedTargets) {
  BehaviorRig s;
  ASSERT_TRUE(
      s.types().add(BehaviorType::create<Probe>("pusher", "Pushes.", BehaviorTargets::parts, probe_properties())).ok());
  Body& body = s.chain("arm", {"base", "tip"});
  BehaviorSetup setup;
  setup.joints = Selection({"to_tip"});
  const std::uint64_t warnings_before = log_count(LogLevel::warning);
  ASSERT_TRUE(s.list().add(body, "pusher", "push", setup).ok());
  EXPECT_EQ(log_count(LogLevel::warning), warnings_before + 1);
}

TEST(BehaviorList, RemovedBehaviorStopsAndFreesItsName) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base"});
  Probe& one = s.probe(body, "one");
  s.probe(body, "two");
  s.ticks(1);
  const NodeId id = one.id();
  BehaviorRig::consume_calls();
  ASSERT_TRUE(s.store.table(id).at("remove").invoke(&one, {}).ok());
  EXPECT_FALSE(s.store.alive(id));
  EXPECT_EQ(body.behaviors().find("one"), nullptr);
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step b/two"}));
  // its name is free again
  s.probe(body, "one");
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step b/two", "start b/one", "step b/one"}));
}

/// Calls a function while behaviors are stepped, to remove something.
class Remover : public Behavior {
 public:
  static inline std::function<void()> action;
  void step(double) override {
    if (action) std::exchange(action, {})();
  }
};

TEST(BehaviorList, AllowsRemovalWhileStepping) {
  BehaviorRig s;
  ASSERT_TRUE(s.types().add(BehaviorType::create<Remover>("remover", "Removes.", BehaviorTargets::any, {})).ok());
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  Probe& before = s.probe(a, "before");
  Behavior& remover = **s.list().add(a, "remover", "r");
  Probe& after = s.probe(a, "after");
  BehaviorGroup& group = s.group("flock");
  s.probe(b, "last");
  s.ticks(1);
  const auto tick_with = [&](std::function<void()> action) {
    BehaviorRig::consume_calls();
    Remover::action = std::move(action);
    s.ticks(1);
    return BehaviorRig::consume_calls();
  };
  EXPECT_EQ(tick_with([&] { s.list().remove(after); }),
            (Words{"step a/before", "step a/flock", "step b/flock", "step b/last"}));
  EXPECT_EQ(tick_with([&] { s.list().remove(before); }),
            (Words{"step a/before", "step a/flock", "step b/flock", "step b/last"}));
  EXPECT_EQ(tick_with([&] { s.world.remove_body(b); }), (Words{"step a/flock"}));
  EXPECT_EQ(tick_with([&] { s.list().remove(group); }), Words{});
  EXPECT_EQ(tick_with([&] { s.list().remove(remover); }), Words{});
  EXPECT_EQ(a.behaviors().list().size(), 0U);
  s.ticks(1);
}

TEST(BehaviorList, CopyHasTheBehaviorsWithTheirValues) {
  BehaviorRig s;
  Body& arm = s.chain("arm", {"base", "tip"});
  Probe& p = s.probe(arm, "p", on_parts({"tip"}));
  BehaviorGroup& named = s.group("named", group_of({"arm"}, {"tip"}));
  BehaviorGroup& pattern = s.group("pattern", group_of({"*"}, {"all"}));
  s.set(p.id(), "amount", {7});
  s.set(p.id(), "way", {3, 2, 1});
  s.set(p.id(), "active", {0});
  s.set(arm.behaviors().find("named")->id(), "amount", {-4});
  Body& twin = **s.world.copy_body(arm, "twin");
  EXPECT_EQ(names_in(twin.behaviors().list()), (Words{"p", "named", "pattern"}));
  const Behavior& copy = *twin.behaviors().find("p");
  EXPECT_EQ(s.number(copy.id(), "amount"), 7);
  EXPECT_EQ(s.get(copy.id(), "way"), (std::vector<double>{3, 2, 1}));
  EXPECT_EQ(s.number(copy.id(), "active"), 0);
  EXPECT_EQ(names_in(copy.parts()), (Words{"tip"}));
  EXPECT_EQ(&copy.parts()[0]->body(), &twin);
  // group membership is copied too, although the group names only the original
  EXPECT_EQ(s.number(twin.behaviors().find("named")->id(), "amount"), -4);
  EXPECT_EQ(twin.behaviors().find("named")->group(), &named);
  EXPECT_EQ(twin.behaviors().find("pattern")->group(), &pattern);
  s.ticks(2);
  EXPECT_EQ(named.members().size(), 2U);
  EXPECT_EQ(pattern.members().size(), 2U);
  EXPECT_EQ(named.neighbor_parts().size(), 2U);
  // a copy has its own values
  s.set(p.id(), "amount", {1});
  EXPECT_EQ(s.number(copy.id(), "amount"), 7);
}

TEST(BehaviorList, RemovingABodyRemovesItsBehaviors) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  s.probe(a, "p");
  s.probe(b, "p");
  BehaviorGroup& group = s.group("flock");
  s.ticks(1);
  BehaviorRig::consume_calls();
  s.world.remove_body(a);
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step b/p", "step b/flock"}));
  EXPECT_EQ(group.members().size(), 1U);
  s.world.clear();
  EXPECT_EQ(s.list().groups().size(), 0U);
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), Words{});
}

TEST(BehaviorList, RunsAreRepeatableBitForBit) {
  const auto run = [] {
    BehaviorRig s;
    Body& a = s.chain("a", {"base", "tip"});
    s.probe(a, "p");
    s.group("flock");
    s.world.copy_body(a, "b").value()->set_pose({{0, 3, 0}, quat_identity()});
    s.ticks(30);
    return s.world.state_hash();
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace limber::sim
