// Rollback of behaviors: after a failed call, removed behaviors, start flags and random draws are as before, and
// stepping continues.
#include "sim/behavior/behavior_transaction.h"

#include <functional>

#include "sim/behavior_rig.h"

namespace limber::sim {
namespace {

using namespace test;

struct UndoScene {
  BehaviorRig& s;
  Body &a, &b, &bare;
  Probe &one, &two, &three;
  BehaviorGroup& flock;
};

/// The final state of a run: a hash of poses, values, generators and timers, the logged steps, and the step order.
struct RunResult {
  std::uint64_t hash = 0;
  Words steps, order;
  bool operator==(const RunResult&) const = default;
};

// Runs ten ticks, the call, and ten more ticks.
RunResult run_with_call(const std::function<void(UndoScene&)>& call, bool commit) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base", "tip"});
  Body& b = s.chain("b", {"base"});
  Body& bare = s.body("bare");
  Probe& one = s.probe(a, "one");
  BehaviorGroup& flock = s.group("flock");
  UndoScene scene{s, a, b, bare, one, s.probe(a, "two"), s.probe(b, "three"), flock};
  s.ticks(10);
  BehaviorRig::consume_calls();
  s.world.transaction().begin();
  call(scene);
  if (commit) {
    s.world.transaction().commit();
  } else {
    s.world.transaction().rollback();
  }
  s.ticks(10);
  return {s.world.state_hash(), BehaviorRig::consume_calls(), s.list().order().keys()};
}

struct ListChange {
  const char* name;
  std::function<void(UndoScene&)> call;
};

const std::vector<ListChange>& list_changes() {
  static const std::vector<ListChange> list = {
      {"remove the first behavior", [](UndoScene& c) { c.s.list().remove(c.one); }},
      {"remove a behavior in the middle", [](UndoScene& c) { c.s.list().remove(c.two); }},
      {"remove two behaviors of a body", [](UndoScene& c) { c.s.list().remove(c.two), c.s.list().remove(c.one); }},
      {"remove all behaviors that are not group members",
       [](UndoScene& c) { c.s.list().remove(c.one), c.s.list().remove(c.three), c.s.list().remove(c.two); }},
      {"remove a group", [](UndoScene& c) { c.s.list().remove(c.flock); }},
      {"remove a member", [](UndoScene& c) { c.s.list().remove(*c.flock.members()[0]); }},
      {"remove a member, then its group",
       [](UndoScene& c) { c.s.list().remove(*c.flock.members()[1]), c.s.list().remove(c.flock); }},
      {"remove a behavior, then its body", [](UndoScene& c) { c.s.list().remove(c.one), c.s.world.remove_body(c.a); }},
      {"remove a body, then its group", [](UndoScene& c) { c.s.world.remove_body(c.a), c.s.list().remove(c.flock); }},
      {"remove a group, then the body of a member",
       [](UndoScene& c) { c.s.list().remove(c.flock), c.s.world.remove_body(c.b); }},
      {"replace a behavior by one with the same name",
       [](UndoScene& c) { c.s.list().remove(c.one), c.s.probe(c.a, "one"); }},
      {"remove a behavior that the call added",
       [](UndoScene& c) { c.s.list().remove(c.s.probe(c.b, "new")), c.s.list().remove(c.two); }},
      {"remove behaviors of a copied body",
       [](UndoScene& c) {
         Body& copy = **c.s.world.copy_body(c.a, "copy");
         c.s.list().remove(*copy.behaviors().list()[0]);
         c.s.list().remove(c.one);
         c.s.list().remove(*copy.behaviors().list()[0]);
       }},
      {"add a part that behaviors act on",
       [](UndoScene& c) {
         ASSERT_TRUE(c.a.add_part("more", c.s.shape(sphere_model(0.1)), 1, {{9, 0, 0}, quat_identity()}));
         c.s.list().update_members();
         ASSERT_EQ(c.one.parts().size(), 3u);
       }},
      {"add a member, then remove another one",
       [](UndoScene& c) {
         ASSERT_TRUE(c.bare.add_part("first", c.s.shape(sphere_model(0.1)), 1, {{9, 0, 0}, quat_identity()}));
         c.s.list().update_members();
         ASSERT_EQ(c.flock.members().size(), 3u);
         c.s.list().remove(*c.flock.members()[0]);
       }},
      {"reset a body", [](UndoScene& c) { c.a.recovery().reset(); }},
      {"set a parameter, then remove the behavior",
       [](UndoScene& c) { c.s.set(c.one.id(), "amount", {7}), c.s.list().remove(c.one); }},
  };
  return list;
}

TEST(BehaviorTransaction, FailedCallRestoresRemovedBehaviors) {
  const RunResult expected = run_with_call([](UndoScene&) {}, true);
  EXPECT_EQ(run_with_call([](UndoScene&) {}, false), expected);
  for (const ListChange& change : list_changes()) {
    EXPECT_EQ(run_with_call(change.call, false), expected) << change.name;
    EXPECT_NE(run_with_call(change.call, true), expected) << change.name;
  }
}

TEST(BehaviorTransaction, RemovedBehaviorsAreHiddenDuringTheCall) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Probe& one = s.probe(a, "one");
  BehaviorGroup& flock = s.group("flock");
  s.ticks(1);
  const NodeId id = one.id();
  const NodeId group = flock.id();
  const NodeId member = flock.members()[0]->id();
  s.world.transaction().begin();
  s.list().remove(one);
  s.list().remove(flock);
  for (const NodeId node : {id, group, member}) EXPECT_FALSE(s.store.alive(node));
  EXPECT_EQ(a.behaviors().find("one"), nullptr);
  EXPECT_EQ(s.list().find_group("flock"), nullptr);
  EXPECT_TRUE(a.behaviors().list().empty());
  EXPECT_TRUE(s.list().order().keys().empty());
  s.world.transaction().rollback();
  for (const NodeId node : {id, group, member}) EXPECT_TRUE(s.store.alive(node));
  EXPECT_EQ(a.behaviors().find("one"), &one);
  EXPECT_EQ(s.list().find_group("flock"), &flock);
  EXPECT_EQ(names_in(a.behaviors().list()), (Words{"one", "flock"}));
  EXPECT_EQ(s.list().order().keys(), (Words{"a/one", "/flock"}));
}

TEST(BehaviorTransaction, CommittedRemovalIsFinal) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  s.probe(a, "one");
  BehaviorGroup& flock = s.group("flock");
  s.ticks(1);
  const std::size_t slots = s.store.view()->slot_count;
  s.world.transaction().begin();
  s.list().remove(*a.behaviors().find("one"));
  s.list().remove(*b.behaviors().find("flock"));
  s.world.transaction().commit();
  BehaviorRig::consume_calls();
  s.ticks(2);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step a/flock", "step a/flock"}))
      << "the removed member is not added again";
  s.world.transaction().begin();
  s.list().remove(flock);
  s.world.transaction().commit();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), Words{});
  s.probe(b, "next");
  s.group("next flock");
  EXPECT_EQ(s.store.view()->slot_count, slots) << "released slots are reused";
}

// A behavior that changes the list in its step, as in a guarded call.
struct GuardedBehavior : Behavior {
  static inline std::function<void(GuardedBehavior&)> action;
  static inline bool commit = true;
  void step(double) override {
    WorldTransaction& undo = world().transaction();
    undo.begin();
    action(*this);
    commit ? undo.commit() : undo.rollback();
  }
};

TEST(BehaviorTransaction, RollsBackChangesDuringStep) {
  BehaviorRig s;
  ASSERT_TRUE(s.types().add(BehaviorType::create<GuardedBehavior>("guarded", "Acts.", BehaviorTargets::any, {})).ok());
  Body& a = s.chain("a", {"base"});
  s.probe(a, "before");
  ASSERT_TRUE(s.list().add(a, "guarded", "g").ok());
  s.group("flock");
  s.probe(a, "after");
  GuardedBehavior::action = [](GuardedBehavior&) {};
  s.ticks(1);
  const auto tick_with = [&](bool commit) {
    BehaviorRig::consume_calls();
    GuardedBehavior::commit = commit;
    s.ticks(1);
    return BehaviorRig::consume_calls();
  };
  GuardedBehavior::action = [](GuardedBehavior& self) {
    BehaviorList& list = self.world().behaviors();
    for (const char* name : {"after", "before"}) list.remove(*self.body().behaviors().find(name));
    list.remove(*list.find_group("flock"));
    list.remove(self);
  };
  EXPECT_EQ(tick_with(false), (Words{"step a/before", "step a/flock", "step a/after"}));
  EXPECT_EQ(s.list().order().keys(), (Words{"a/before", "a/g", "/flock", "a/after"}));
  EXPECT_EQ(tick_with(false), (Words{"step a/before", "step a/flock", "step a/after"}));
  EXPECT_EQ(tick_with(true), (Words{"step a/before"}));
  EXPECT_TRUE(s.list().order().keys().empty());
  s.ticks(1);
}

TEST(BehaviorTransaction, RestoresGeneratorsTimersAndErrors) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Probe& one = s.probe(a, "one");
  Probe& broken = s.probe(a, "broken");
  s.set(broken.id(), "broken", {1});
  s.ticks(1);
  ASSERT_NE(broken.error(), "");
  const Property& beat = one.type().table->at("beat");
  const std::uint64_t before = one.state_hash(0);
  s.world.transaction().begin();
  one.save_for_rollback();
  (void)one.random().uniform();
  s.set(one.id(), "beat", {1});
  EXPECT_TRUE(one.interval_elapsed(beat)) << "every tick";
  s.set(broken.id(), "active", {1});
  EXPECT_EQ(broken.error(), "") << "the error is cleared";
  s.world.transaction().rollback();
  EXPECT_EQ(one.state_hash(0), before);
  EXPECT_EQ(broken.error(), "it is broken");
  BehaviorRig::consume_calls();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::consume_calls(), (Words{"step a/one"}));
}

// A part that an earlier call added is a target, even if the call that resolved the targets failed.
TEST(BehaviorTransaction, TargetsAreResolvedAgainAfterARollback) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Probe& one = s.probe(a, "one");
  s.ticks(1);
  ASSERT_EQ(one.parts().size(), 1u);
  ASSERT_TRUE(a.add_part("added", s.shape(sphere_model(0.05)), 1, {{3, 0, 0}, quat_identity()}).ok());
  s.world.transaction().begin();
  s.list().update_members();
  EXPECT_EQ(one.parts().size(), 2u);
  s.world.transaction().rollback();
  s.ticks(1);
  EXPECT_EQ(one.parts().size(), 2u);
}

TEST(BehaviorTransaction, RejectedGroupLeavesNothingBehind) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  s.probe(b, "taken");
  s.world.transaction().begin();
  EXPECT_EQ(s.add_group_error("probe_group", "taken"), "body 'b' has a behavior 'taken' already; names are unique");
  EXPECT_TRUE(a.behaviors().list().empty());
  s.world.transaction().rollback();
  EXPECT_TRUE(a.behaviors().list().empty());
  s.ticks(1);
}

}  // namespace
}  // namespace limber::sim
