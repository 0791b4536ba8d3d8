// How behaviours go: in guarded calls that fail they come back, as if nobody had touched them.
#include <gtest/gtest.h>

#include <functional>

#include "behavior_rig.h"
#include "sim/world_undo.h"

namespace limber {
namespace {

using namespace test;

using Diary = std::vector<std::string>;

// two bodies, each with a single and a group's probe between; what they write in a step after the call
struct Removal : BehaviorRig {
  Removal() {
    a = &chain("a", {"one"});
    b = &chain("b", {"one"});
    first = &probe(*a, "first");
    swarm = &group("swarm");
    last = &probe(*a, "last");
    world.step();
    take_diary();
  }
  Diary after_call(const std::function<void()>& call, bool good) {
    world.undo().begin();
    call();
    if (good) {
      world.undo().end();
    } else {
      world.undo().take_back();
    }
    world.step();
    return take_diary();
  }
  Body *a = nullptr, *b = nullptr;
  Probe *first = nullptr, *last = nullptr;
  BehaviorGroup* swarm = nullptr;
};

const Diary kAll = {"step a/first", "step a/swarm", "step b/swarm", "step a/last"};

TEST(BehaviorRemoval, ThatFailsLeavesAllInItsPlace) {
  Removal r;
  const NodeId id = r.first->id();
  const auto remove = [&] {
    r.list().remove(*r.first);
    EXPECT_FALSE(r.store.alive(id));
    EXPECT_EQ(r.a->find_behavior("first"), nullptr);
    r.list().remove(*r.swarm->members()[0]);
  };
  EXPECT_EQ(r.after_call(remove, false), kAll);
  EXPECT_EQ(r.a->find_behavior("first"), r.first);
  EXPECT_EQ(r.first->id(), id);
  std::vector<std::string> names;
  for (const Behavior* behavior : r.a->behaviors()) names.push_back(behavior->name());
  EXPECT_EQ(names, (std::vector<std::string>{"first", "swarm", "last"}));
}

TEST(BehaviorRemoval, ThatEndsWellIsForGood) {
  Removal r;
  const NodeId id = r.first->id();
  const std::size_t slots = r.store.view()->slot_count;
  const auto remove = [&] {
    r.list().remove(*r.first);
    r.list().remove(*r.swarm->members()[0]);
  };
  EXPECT_EQ(r.after_call(remove, true), (Diary{"step b/swarm", "step a/last"}));
  EXPECT_FALSE(r.store.alive(id));
  r.probe(*r.a, "first");
  r.probe(*r.a, "more");
  EXPECT_EQ(r.store.view()->slot_count, slots) << "in slots of those that have gone";
}

TEST(BehaviorRemoval, OfAGroupTakesItsMembersAlong) {
  Removal r;
  const auto remove = [&] {
    r.list().remove_group(*r.swarm);
    EXPECT_EQ(r.list().find_group("swarm"), nullptr);
    EXPECT_TRUE(r.list().groups().empty());
  };
  EXPECT_EQ(r.after_call(remove, false), kAll);
  EXPECT_EQ(r.list().find_group("swarm"), r.swarm);
  EXPECT_EQ(r.after_call(remove, true), (Diary{"step a/first", "step a/last"}));
}

TEST(BehaviorRemoval, WithItsBody) {
  Removal r;
  const auto remove = [&] {
    r.list().remove(*r.first);
    r.world.remove_body(*r.a);
  };
  EXPECT_EQ(r.after_call(remove, false), kAll);
  EXPECT_EQ(r.after_call(remove, true), Diary{"step b/swarm"});
}

TEST(BehaviorRemoval, OfOneThatWasJustMade) {
  Removal r;
  const auto make = [&] { r.list().remove(r.probe(*r.b, "new")); };
  EXPECT_EQ(r.after_call(make, false), kAll);
  EXPECT_EQ(r.after_call(make, true), kAll);
  EXPECT_EQ(r.list().order(), (std::vector<std::string>{"a/first", "/swarm", "a/last"}));
}

TEST(BehaviorRemoval, AnErrorThatWasClearedStandsAgain) {
  Removal r;
  r.set(r.first->id(), "broken", {1});
  r.world.step();
  ASSERT_EQ(r.first->error(), "it is broken");
  r.take_diary();
  const auto revive = [&] {
    r.set(r.first->id(), "active", {1});
    EXPECT_EQ(r.first->error(), "");
  };
  EXPECT_EQ(r.after_call(revive, false), (Diary{"step a/swarm", "step b/swarm", "step a/last"}));
  EXPECT_EQ(r.first->error(), "it is broken");
}

TEST(BehaviorRemoval, AStartThatWasAskedForIsForgotten) {
  Removal r;
  EXPECT_EQ(r.after_call([&] { r.a->reset(); }, false), kAll);
  Random drawn = r.first->random();
  r.after_call([&] { r.a->reset(); }, false);
  EXPECT_EQ(r.first->last, drawn.uniform()) << "its draws go on";
  EXPECT_EQ(r.after_call([&] { r.a->reset(); }, true),
            (Diary{"start a/first", "step a/first", "start a/swarm", "step a/swarm", "step b/swarm", "start a/last",
                   "step a/last"}));
}

}  // namespace
}  // namespace limber
