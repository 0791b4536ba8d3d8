// Behavior places: moving behaviors in the step order.
#include "sim/behavior_rig.h"

namespace limber::sim {
namespace {

using namespace test;

struct PlacesRig : BehaviorRig {
  Body& a = chain("a", {"base"});
  Body& b = chain("b", {"base"});
  Probe& a_one = probe(a, "one");
  Probe& b_one = probe(b, "one");
  BehaviorGroup& flock = group("flock");
  Probe& a_two = probe(a, "two");
  Probe& b_two = probe(b, "two");

  Words tick() {
    consume_calls();
    ticks(1);
    return consume_calls();
  }
  Words after_start() {
    ticks(1);
    return tick();
  }
};

TEST(BehaviorPlaces, ArePublishedAsProperties) {
  PlacesRig s;
  EXPECT_EQ(s.number(s.a_one.id(), "place"), 1);
  EXPECT_EQ(s.number(s.a_two.id(), "place"), 3) << "the group counts, since it acts on this body";
  EXPECT_EQ(s.number(s.b_two.id(), "place"), 3);
  EXPECT_EQ(s.number(s.flock.id(), "place"), 2) << "one, flock, two";
}

TEST(BehaviorPlaces, MovesABehaviorAmongThoseOfItsBody) {
  PlacesRig s;
  s.set(s.a_two.id(), "place", {1});
  EXPECT_EQ(s.after_start(),
            (Words{"step a/two", "step a/one", "step b/one", "step a/flock", "step b/flock", "step b/two"}));
  EXPECT_EQ(s.number(s.a_two.id(), "place"), 1);
  EXPECT_EQ(s.number(s.a_one.id(), "place"), 2);
  s.set(s.a_one.id(), "place", {1000});
  EXPECT_EQ(s.tick(), (Words{"step a/two", "step b/one", "step a/flock", "step b/flock", "step a/one", "step b/two"}))
      << "directly after the last behavior of its body";
  EXPECT_EQ(s.number(s.a_one.id(), "place"), 3);
}

TEST(BehaviorPlaces, MovesAGroupAmongNames) {
  PlacesRig s;
  s.set(s.flock.id(), "place", {1});
  EXPECT_EQ(s.after_start(),
            (Words{"step a/flock", "step b/flock", "step a/one", "step b/one", "step a/two", "step b/two"}));
  s.set(s.flock.id(), "place", {3});
  EXPECT_EQ(s.tick(), (Words{"step a/one", "step b/one", "step a/two", "step b/two", "step a/flock", "step b/flock"}));
  EXPECT_EQ(s.number(s.flock.id(), "place"), 3);
}

TEST(BehaviorPlaces, MembersHaveThePlaceOfTheirGroup) {
  PlacesRig s;
  const Behavior& member = *s.flock.members()[0];
  const double first = 1;
  const Result<SetOutcome> set = s.store.set(member.id(), "place", {&first, 1});
  ASSERT_FALSE(set.ok());
  EXPECT_NE(set.error().find("set /physics/group/flock/place"), std::string::npos) << set.error();
}

TEST(BehaviorPlaces, FailedCallRestoresTheOrder) {
  PlacesRig s;
  const Words before = s.list().order().keys();
  s.world.transaction().begin();
  s.set(s.a_two.id(), "place", {1});
  s.list().remove(s.a_one);
  s.set(s.flock.id(), "place", {1});
  EXPECT_NE(s.list().order().keys(), before);
  s.world.transaction().rollback();
  EXPECT_EQ(s.list().order().keys(), before);
  EXPECT_EQ(s.number(s.a_two.id(), "place"), 3);
}

TEST(BehaviorPlaces, ChangedOrderRestartsTheHistory) {
  PlacesRig s;
  const std::uint64_t before = s.store.structure_version();
  s.set(s.a_two.id(), "place", {3});
  EXPECT_EQ(s.store.structure_version(), before) << "its place is unchanged";
  s.set(s.a_two.id(), "place", {2});
  EXPECT_NE(s.store.structure_version(), before);
}

}  // namespace
}  // namespace limber::sim
