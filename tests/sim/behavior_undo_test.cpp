// Behaviours in guarded calls: what a failing one removed, started or drew is as it was, and steps on.
#include "sim/behavior_undo.h"

#include <functional>

#include "sim/behavior_rig.h"

namespace limber {
namespace {

using namespace test;

struct Cast {
  BehaviorRig& s;
  Body &a, &b, &bare;
  Probe &one, &two, &three;
  BehaviorGroup& flock;
};

/// What is left of a play: the bits of poses, rows, generators and beats, who stepped, in which order they stand.
struct Left {
  std::uint64_t hash = 0;
  Words steps, order;
  bool operator==(const Left&) const = default;
};

// ten ticks, the call, ten ticks more
Left play(const std::function<void(Cast&)>& call, bool good) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base", "tip"});
  Body& b = s.chain("b", {"base"});
  Body& bare = s.body("bare");
  Probe& one = s.probe(a, "one");
  BehaviorGroup& flock = s.group("flock");
  Cast cast{s, a, b, bare, one, s.probe(a, "two"), s.probe(b, "three"), flock};
  s.ticks(10);
  BehaviorRig::take_diary();
  s.world.undo().begin();
  call(cast);
  if (good) {
    s.world.undo().end();
  } else {
    s.world.undo().take_back();
  }
  s.ticks(10);
  return {s.world.state_hash(), BehaviorRig::take_diary(), s.list().order()};
}

struct ListDeed {
  const char* name;
  std::function<void(Cast&)> call;
};

const std::vector<ListDeed>& list_deeds() {
  static const std::vector<ListDeed> list = {
      {"the first", [](Cast& c) { c.s.list().remove(c.one); }},
      {"one in the middle", [](Cast& c) { c.s.list().remove(c.two); }},
      {"two of one body", [](Cast& c) { c.s.list().remove(c.two), c.s.list().remove(c.one); }},
      {"all that are no members",
       [](Cast& c) { c.s.list().remove(c.one), c.s.list().remove(c.three), c.s.list().remove(c.two); }},
      {"a group", [](Cast& c) { c.s.list().remove_group(c.flock); }},
      {"a member", [](Cast& c) { c.s.list().remove(*c.flock.members()[0]); }},
      {"a member, then the group",
       [](Cast& c) { c.s.list().remove(*c.flock.members()[1]), c.s.list().remove_group(c.flock); }},
      {"one, then its body", [](Cast& c) { c.s.list().remove(c.one), c.s.world.remove_body(c.a); }},
      {"a body, then the group it was in",
       [](Cast& c) { c.s.world.remove_body(c.a), c.s.list().remove_group(c.flock); }},
      {"the group, then a body of it", [](Cast& c) { c.s.list().remove_group(c.flock), c.s.world.remove_body(c.b); }},
      {"one, and another under its name", [](Cast& c) { c.s.list().remove(c.one), c.s.probe(c.a, "one"); }},
      {"one that the call has made",
       [](Cast& c) { c.s.list().remove(c.s.probe(c.b, "new")), c.s.list().remove(c.two); }},
      {"a copy's",
       [](Cast& c) {
         Body& copy = **c.s.world.copy_body(c.a, "copy");
         c.s.list().remove(*copy.behaviors()[0]);
         c.s.list().remove(c.one);
         c.s.list().remove(*copy.behaviors()[0]);
       }},
      {"a part that it acts on, too",
       [](Cast& c) {
         ASSERT_TRUE(c.a.add_part("more", c.s.shape(sphere_model(0.1)), 1, {{9, 0, 0}, quat_identity()}));
         c.s.list().follow_bodies();
         ASSERT_EQ(c.one.parts().size(), 3u);
       }},
      {"a member more, which goes at once",
       [](Cast& c) {
         ASSERT_TRUE(c.bare.add_part("first", c.s.shape(sphere_model(0.1)), 1, {{9, 0, 0}, quat_identity()}));
         c.s.list().follow_bodies();
         ASSERT_EQ(c.flock.members().size(), 3u);
         c.s.list().remove(*c.flock.members()[0]);
       }},
      {"a start anew", [](Cast& c) { c.a.reset(); }},
      {"parameters, then away", [](Cast& c) { c.s.set(c.one.id(), "amount", {7}), c.s.list().remove(c.one); }},
  };
  return list;
}

TEST(BehaviorUndo, AFailingCallHasNotRemovedThem) {
  const Left alone = play([](Cast&) {}, true);
  EXPECT_EQ(play([](Cast&) {}, false), alone);
  for (const ListDeed& deed : list_deeds()) {
    EXPECT_EQ(play(deed.call, false), alone) << deed.name;
    EXPECT_NE(play(deed.call, true), alone) << deed.name;
  }
}

TEST(BehaviorUndo, InTheCallTheyAreGone) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Probe& one = s.probe(a, "one");
  BehaviorGroup& flock = s.group("flock");
  s.ticks(1);
  const NodeId id = one.id();
  const NodeId group = flock.id();
  const NodeId member = flock.members()[0]->id();
  s.world.undo().begin();
  s.list().remove(one);
  s.list().remove_group(flock);
  for (const NodeId gone : {id, group, member}) EXPECT_FALSE(s.store.alive(gone));
  EXPECT_EQ(a.find_behavior("one"), nullptr);
  EXPECT_EQ(s.list().find_group("flock"), nullptr);
  EXPECT_TRUE(a.behaviors().empty());
  EXPECT_TRUE(s.list().order().empty());
  s.world.undo().take_back();
  for (const NodeId back : {id, group, member}) EXPECT_TRUE(s.store.alive(back));
  EXPECT_EQ(a.find_behavior("one"), &one);
  EXPECT_EQ(s.list().find_group("flock"), &flock);
  EXPECT_EQ(names_in(a.behaviors()), (Words{"one", "flock"}));
  EXPECT_EQ(s.list().order(), (Words{"a/one", "/flock"}));
}

TEST(BehaviorUndo, AGoodRemovalIsForGood) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  s.probe(a, "one");
  BehaviorGroup& flock = s.group("flock");
  s.ticks(1);
  const std::size_t slots = s.store.view()->slot_count;
  s.world.undo().begin();
  s.list().remove(*a.find_behavior("one"));
  s.list().remove(*b.find_behavior("flock"));
  s.world.undo().end();
  BehaviorRig::take_diary();
  s.ticks(2);
  EXPECT_EQ(BehaviorRig::take_diary(), (Words{"step a/flock", "step a/flock"})) << "nor does the member come again";
  s.world.undo().begin();
  s.list().remove_group(flock);
  s.world.undo().end();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::take_diary(), Words{});
  s.probe(b, "next");
  s.group("next flock");
  EXPECT_EQ(s.store.view()->slot_count, slots) << "in slots of those that have gone";
}

// a behaviour that acts in its step as a guarded call would
struct Guarded : Behavior {
  static inline std::function<void(Guarded&)> act;
  static inline bool good = true;
  void step(double) override {
    WorldUndo& undo = world().undo();
    undo.begin();
    act(*this);
    good ? undo.end() : undo.take_back();
  }
};

TEST(BehaviorUndo, WhileTheyStep) {
  BehaviorRig s;
  ASSERT_TRUE(s.types().add(BehaviorType::of<Guarded>("guarded", "Acts.", BehaviorTargets::any, {})).ok());
  Body& a = s.chain("a", {"base"});
  s.probe(a, "before");
  ASSERT_TRUE(s.list().add(a, "guarded", "g").ok());
  s.group("flock");
  s.probe(a, "after");
  Guarded::act = [](Guarded&) {};
  s.ticks(1);
  const auto tick_with = [&](bool good) {
    BehaviorRig::take_diary();
    Guarded::good = good;
    s.ticks(1);
    return BehaviorRig::take_diary();
  };
  Guarded::act = [](Guarded& self) {
    BehaviorList& list = self.world().behaviors();
    for (const char* name : {"after", "before"}) list.remove(*self.body().find_behavior(name));
    list.remove_group(*list.find_group("flock"));
    list.remove(self);
  };
  EXPECT_EQ(tick_with(false), (Words{"step a/before", "step a/flock", "step a/after"}));
  EXPECT_EQ(s.list().order(), (Words{"a/before", "a/g", "/flock", "a/after"}));
  EXPECT_EQ(tick_with(false), (Words{"step a/before", "step a/flock", "step a/after"}));
  EXPECT_EQ(tick_with(true), (Words{"step a/before"}));
  EXPECT_TRUE(s.list().order().empty());
  s.ticks(1);
}

TEST(BehaviorUndo, DrawsBeatsAndErrorsAreAsTheyWere) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Probe& one = s.probe(a, "one");
  Probe& broken = s.probe(a, "broken");
  s.set(broken.id(), "broken", {1});
  s.ticks(1);
  ASSERT_NE(broken.error(), "");
  const Row& beat = one.type().table->at("beat");
  const std::uint64_t before = one.state_hash(0);
  s.world.undo().begin();
  s.list().undo().keep(one);
  (void)one.random().uniform();
  s.set(one.id(), "beat", {1});
  EXPECT_TRUE(one.due(beat)) << "every tick";
  s.set(broken.id(), "active", {1});
  EXPECT_EQ(broken.error(), "") << "tried again";
  s.world.undo().take_back();
  EXPECT_EQ(one.state_hash(0), before);
  EXPECT_EQ(broken.error(), "it is broken");
  BehaviorRig::take_diary();
  s.ticks(1);
  EXPECT_EQ(BehaviorRig::take_diary(), (Words{"step a/one"}));
}

TEST(BehaviorUndo, ARefusedGroupInACallLeavesNothing) {
  BehaviorRig s;
  Body& a = s.chain("a", {"base"});
  Body& b = s.chain("b", {"base"});
  s.probe(b, "taken");
  s.world.undo().begin();
  EXPECT_EQ(s.group_refusal("probe_group", "taken"), "body 'b' has a behavior 'taken' already; names are unique");
  EXPECT_TRUE(a.behaviors().empty());
  s.world.undo().take_back();
  EXPECT_TRUE(a.behaviors().empty());
  s.ticks(1);
}

}  // namespace
}  // namespace limber
