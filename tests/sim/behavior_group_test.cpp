// Behavior groups: membership, propagated values, neighbors.
#include "sim/behavior/behavior_group.h"

#include "sim/behavior_rig.h"

namespace limber::sim {
namespace {

using namespace test;

Words member_bodies(const BehaviorGroup& group) {
  Words names;
  for (const auto& member : group.members()) names.push_back(member->body().name());
  return names;
}

Words neighbors(const BehaviorGroup& group) {
  Words names;
  for (const Part* part : group.neighbor_parts()) names.push_back(part->body().name() + "/" + part->name());
  return names;
}

TEST(BehaviorGroup, MembersAreTheSelectedBodies) {
  BehaviorRig s;
  for (const char* name : {"arm1", "arm2", "leg"}) s.chain(name, {"base", "tip"});
  s.add_single_part(plane_model(), 0);  // a floor has no movable part: "all" doesn't select it
  EXPECT_EQ(member_bodies(s.group("a")), (Words{"arm1", "arm2", "leg"}));
  EXPECT_EQ(member_bodies(s.group("b", group_of({"arm*"}, {"tip"}))), (Words{"arm1", "arm2"}));
  EXPECT_EQ(member_bodies(s.group("c", group_of({"leg", "arm2"}, {"tip"}))), (Words{"arm2", "leg"}));
  EXPECT_EQ(member_bodies(s.group("d", group_of({"none*"}, {"tip"}))), Words{});
  EXPECT_EQ(names_in(s.world.find_body("arm2")->behaviors().list()), (Words{"a", "b", "c"}));
  EXPECT_EQ(s.store.path(s.world.find_body("leg")->behaviors().find("a")->id()), "/physics/body/leg/behavior/a");
}

TEST(BehaviorGroup, TracksAddedAndRemovedBodies) {
  BehaviorRig s;
  s.chain("arm1", {"base", "tip"});
  BehaviorGroup& group = s.group("flock", group_of({"arm*"}, {"tip"}));
  s.set(group.id(), "amount", {6});
  s.ticks(1);
  Body& late = s.body("arm2");
  s.ticks(1);
  EXPECT_EQ(member_bodies(group), (Words{"arm1"}));  // late has no tip yet
  ASSERT_TRUE(late.add_part("tip", s.shape(sphere_model(0.1)), 1, {{0, 5, 0}, quat_identity()}).ok());
  s.ticks(1);
  EXPECT_EQ(member_bodies(group), (Words{"arm1", "arm2"}));
  EXPECT_EQ(neighbors(group), (Words{"arm1/tip", "arm2/tip"}));
  EXPECT_EQ(s.number(late.behaviors().find("flock")->id(), "amount"), 6);  // new members get the group's values
  s.world.remove_body(*s.world.find_body("arm1"));
  s.ticks(1);
  EXPECT_EQ(member_bodies(group), (Words{"arm2"}));
  EXPECT_EQ(neighbors(group), (Words{"arm2/tip"}));
}

TEST(BehaviorGroup, SettingAValueSetsItOnEveryMemberAtOnce) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  BehaviorGroup& group = s.group("flock");
  const NodeId id_a = a.behaviors().find("flock")->id();
  const NodeId id_b = b.behaviors().find("flock")->id();
  s.set(id_a, "amount", {9});
  EXPECT_EQ(s.number(id_b, "amount"), 2);
  EXPECT_EQ(s.number(group.id(), "amount"), 2);
  // even if the group's own value doesn't change; the last write wins
  s.set(group.id(), "amount", {2});
  EXPECT_EQ(s.number(id_a, "amount"), 2);
  s.set(id_a, "amount", {5});
  s.ticks(3);
  EXPECT_EQ(s.number(id_a, "amount"), 5);
  s.set(group.id(), "way", {7, 8, 9});
  EXPECT_EQ(s.get(id_b, "way"), (std::vector<double>{7, 8, 9}));
  s.set(group.id(), "amount", {1e6});  // clamped to the range in both
  EXPECT_EQ(s.number(id_a, "amount"), 10);
  s.set(group.id(), "active", {0});
  BehaviorRig::consume_calls();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), Words{});
}

TEST(BehaviorGroup, NeighborsMayDifferFromItsOwnParts) {
  BehaviorRig s;
  s.chain("a", {"base", "tip"});
  s.chain("b", {"base", "tip"});
  s.chain("rock", {"stone"}, 0);
  EXPECT_EQ(neighbors(s.group("as_parts", group_of({"*"}, {"tip"}))), (Words{"a/tip", "b/tip"}));
  GroupSetup setup = group_of({"*"}, {"tip"});
  setup.neighbor_parts = Selection({"base", "stone"});
  BehaviorGroup& group = s.group("others", setup);
  EXPECT_EQ(neighbors(group), (Words{"a/base", "b/base", "rock/stone"}));  // a static part selected by name
  EXPECT_EQ(member_bodies(group), (Words{"a", "b"}));
  // equal sets of parts share one neighbor set
  setup.parts = Selection({"base"});
  EXPECT_EQ(&s.group("again", setup).neighbors(), &group.neighbors());
}

TEST(BehaviorGroup, ErrorsSuggestExistingNames) {
  BehaviorRig s;
  s.chain("arm", {"base", "tip"});
  s.chain("leg", {"base", "foot"});
  EXPECT_EQ(s.add_group_error("probe_group", "g", group_of({"amr"}, {"tip"})),
            "there is no body 'amr'; did you mean 'arm'?");
  EXPECT_EQ(s.add_group_error("probe_group", "g", group_of({"arm", "leg"}, {"tip"})),
            "body 'leg' has no part 'tip'; there are: base, foot");
  EXPECT_EQ(s.add_group_error("probe_group", "g", group_of({"all"}, {"tipp"})),
            "body 'arm' has no part 'tipp'; did you mean 'tip'?");
  EXPECT_EQ(s.add_group_error("probe_group", "g", group_of({"all"}, {"tip", "foot"})), "");
  EXPECT_EQ(s.add_group_error("probe_group", "g"), "there is a group behavior 'g' already; names are unique");
  s.probe(*s.world.find_body("leg"), "taken");
  EXPECT_EQ(s.add_group_error("probe_group", "taken"), "body 'leg' has a behavior 'taken' already; names are unique");
  // a rejected group leaves nothing behind
  EXPECT_EQ(s.world.find_body("arm")->behaviors().find("taken"), nullptr);
  EXPECT_EQ(s.list().find_group("taken"), nullptr);
  EXPECT_EQ(s.list().groups().size(), 1U);
}

TEST(BehaviorGroup, RemovedMemberIsNotAddedAgain) {
  BehaviorRig s;
  s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  BehaviorGroup& group = s.group("flock");
  s.list().remove(*b.behaviors().find("flock"));
  s.chain("c", {"base"});
  s.ticks(1);
  EXPECT_EQ(member_bodies(group), (Words{"a", "c"}));
}

TEST(BehaviorGroup, ErrorSuspendsOnlyOneMember) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  s.chain("b", {"base"});
  s.group("flock");
  s.ticks(1);
  s.list().on_fault([](const Behavior&) {});
  s.set(a.behaviors().find("flock")->id(), "broken", {1});
  BehaviorRig::consume_calls();
  s.ticks(2);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step a/flock", "step b/flock", "step b/flock"}));
  s.set(a.behaviors().find("flock")->id(), "broken", {0});
  s.set(a.behaviors().find("flock")->id(), "active", {1});
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step a/flock", "step b/flock"}));
}

TEST(BehaviorGroup, HashCoversItsValues) {
  const auto hash = [](double amount, double member_amount) {
    BehaviorRig s;
    Body& a = s.chain("a", {"base"});
    BehaviorGroup& group = s.group("flock");
    s.set(group.id(), "amount", {amount});
    s.set(a.behaviors().find("flock")->id(), "amount", {member_amount});
    s.ticks(1);
    return s.world.state_hash();
  };
  EXPECT_EQ(hash(3, 4), hash(3, 4));
  EXPECT_NE(hash(3, 4), hash(2, 4));
  EXPECT_NE(hash(3, 4), hash(3, 5));
}

}  // namespace
}  // namespace limber::sim
