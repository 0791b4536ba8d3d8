// Behavior types: the naming rule; adding, replacing and removing types; replacing instances.
#include "sim/behavior/behavior_type.h"

#include "sim/behavior_rig.h"

namespace limber::sim {
namespace {

using namespace test;

BehaviorType probe_type(std::string name, std::vector<Property> properties = probe_properties()) {
  return BehaviorType::create<Probe>(std::move(name), "A probe.", BehaviorTargets::any, std::move(properties));
}

TEST(BehaviorTypes, LookupIgnoresCaseUnderscoresAndSuffix) {
  BehaviorTypes types;
  ASSERT_TRUE(types.add(probe_type("random_push")).ok());
  for (const char* name : {"random_push", "RandomPush", "randompush", "RandomPushBehavior", "RANDOM_PUSH_BEHAVIOR"})
    EXPECT_NE(types.find(name), nullptr) << name;
  EXPECT_EQ(types.find("random"), nullptr);
  EXPECT_EQ(types.find("behavior"), nullptr);
  EXPECT_EQ(types.require("RandomPsuhBehavior").error(),
            "there is no behavior type 'RandomPsuhBehavior'; did you mean 'random_push'?");
}

TEST(BehaviorTypes, ReplacesAndRemovesTypes) {
  BehaviorTypes types;
  ASSERT_TRUE(types.add(probe_type("wave")).ok());
  const auto first = types.find("wave");
  ASSERT_TRUE(types.add(probe_type("Wave")).ok());
  EXPECT_EQ(types.all().size(), 1U + BehaviorTypes().all().size());
  EXPECT_NE(types.find("wave"), first);
  types.remove("WAVE");
  EXPECT_EQ(types.find("wave"), nullptr);
}

TEST(BehaviorTypes, BuiltInNamesCannotBeReplaced) {
  static const BuiltInBehavior registered([] { return probe_type("test_built_in"); });
  BehaviorTypes types;
  EXPECT_EQ(types.add(probe_type("TestBuiltIn")).error(),
            "'TestBuiltIn' is a built-in behavior type ('test_built_in'); rename the file");
  types.remove("test_built_in");
  EXPECT_NE(types.find("test_built_in"), nullptr);
  EXPECT_FALSE(types.add(probe_type("")).ok());
}

TEST(BehaviorTypes, EqualTablesAreShared) {
  EXPECT_EQ(probe_type("same").table, probe_type("same").table);
  EXPECT_NE(probe_type("same").table, probe_type("other").table);
}

TEST(BehaviorTypes, ReplacedInstancesKeepCommonProperties) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base", "tip"});
  Probe& before = s.probe(body, "p", on_parts({"tip"}));
  s.probe(body, "other");
  s.set(before.id(), "amount", {9});
  s.set(before.id(), "way", {4, 5, 6});
  s.set(before.id(), "active", {0});
  s.set(before.id(), "active", {1});
  s.ticks(3);
  const auto generator = before.random().state();
  const NodeId id_before = before.id();
  // the range of amount is narrower, way is a number now, there is a new property, beat is unchanged
  ASSERT_TRUE(s.types()
                  .add(probe_type("probe", {properties::number("amount", "N", 1, -5, 5, "A number."),
                                            properties::boolean("broken", false, "Whether it errs."),
                                            properties::number("way", "m", 8, -100, 100, "A number now."),
                                            properties::number("beat", "ms", 100, 0, 1e6, "An interval."),
                                            properties::number("fresh", "", 3, 0, 9, "A new one.")}))
                  .ok());
  s.list().replace_instances("probe");
  Behavior& after = *body.behaviors().find("p");
  EXPECT_EQ(s.number(after.id(), "amount"), 5);
  EXPECT_EQ(s.number(after.id(), "way"), 8);
  EXPECT_EQ(s.number(after.id(), "fresh"), 3);
  EXPECT_FALSE(s.store.alive(id_before));
  EXPECT_EQ(after.random().state(), generator);
  EXPECT_EQ(names_in(after.parts()), (Words{"tip"}));
  EXPECT_EQ(names_in(body.behaviors().list()), (Words{"p", "other"}));
  EXPECT_EQ(static_cast<Probe&>(after).elapsed_count, 101);
  BehaviorRig::consume_calls();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step b/p", "step b/other"}));
}

TEST(BehaviorTypes, ReplacingWithTheSamePropertiesKeepsTheNode) {
  BehaviorRig s;
  Body& body = s.chain("b", {"base"});
  Probe& before = s.probe(body, "p");
  s.set(before.id(), "amount", {9});
  const NodeId id = before.id();
  ASSERT_TRUE(s.types().add(probe_type("probe")).ok());
  s.list().replace_instances("probe");
  EXPECT_EQ(body.behaviors().find("p")->id(), id);
  EXPECT_EQ(s.number(id, "amount"), 9);
}

TEST(BehaviorTypes, GroupsAreReplacedWithTheirMembers) {
  BehaviorRig s;
  s.chain("a", {"base"});
  s.chain("b", {"base"});
  BehaviorGroup& group = s.group("g");
  s.set(group.id(), "amount", {7});
  s.set(s.world.find_body("a")->behaviors().find("g")->id(), "amount", {8});
  std::vector<Property> properties = probe_properties();
  properties.push_back(properties::number("fresh", "", 3, 0, 9, "A new one."));
  ASSERT_TRUE(s.types().add(BehaviorType::create_group<Probe>("probe_group", "Probes.", properties)).ok());
  s.list().replace_instances("probe_group");
  EXPECT_EQ(s.number(group.id(), "amount"), 7);
  s.set(group.id(), "fresh", {5});
  for (const char* name : {"a", "b"}) {
    const NodeId id = s.world.find_body(name)->behaviors().find("g")->id();
    EXPECT_EQ(s.number(id, "fresh"), 5);
    EXPECT_EQ(s.number(id, "amount"), name[0] == 'a' ? 8 : 7);
  }
}

}  // namespace
}  // namespace limber::sim
