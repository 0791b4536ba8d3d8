// Two descriptions, what differs, and how it is applied: worlds made by hand, no scene.
#include "engine/difference.h"

#include "engine/apply.h"
#include "engine/rig.h"

namespace limber::engine_test {
namespace {

constexpr std::uint64_t bit(std::uint32_t row) { return std::uint64_t{1} << row; }

SaidRow row(std::uint32_t number, bool said, double value) { return {number, said, {value, 0, 0, 0}}; }

TEST(Difference, APairOfValueAndSaying) {
  const SaidRows nothing;
  const SaidRows unsaid{row(3, false, 1)};
  const SaidRows said{row(3, true, 1)};
  const SaidRows other{row(3, true, 2)};
  const SaidRows other_default{row(3, false, 2)};
  EXPECT_EQ(changed_rows(nothing, nothing), 0u);
  EXPECT_EQ(changed_rows(said, said), 0u);
  EXPECT_EQ(changed_rows(unsaid, unsaid), 0u);
  EXPECT_EQ(changed_rows(said, other), bit(3));
  EXPECT_EQ(changed_rows(unsaid, other_default), bit(3)) << "another default";
  EXPECT_EQ(changed_rows(unsaid, said), bit(3)) << "said for the first time";
  EXPECT_EQ(changed_rows(said, unsaid), bit(3)) << "no longer said";
  EXPECT_EQ(changed_rows(nothing, said), bit(3));
  EXPECT_EQ(changed_rows(said, nothing), bit(3));
  const SaidRows before{row(1, true, 0), row(4, true, 0), row(7, true, 0)};
  const SaidRows now{row(2, true, 0), row(4, true, 0), row(7, true, 1)};
  EXPECT_EQ(changed_rows(before, now), bit(1) | bit(2) | bit(7));
}

// a world that a test changes a little before it is described
struct Ground {
  Store store;
  World world;
  Ground() : world(store) { build_bodies(world); }

  Body& body(const char* name) { return *world.find_body(name); }
  template <std::size_t N>
  void say(NodeId id, const char* row, const double (&values)[N]) {
    const Store::Saying saying(store, true);
    ASSERT_TRUE(store.set(id, row, values).ok());
  }
  Description told() {
    world.stand();
    return describe(world);
  }
};

TEST(Difference, TheSameWorldTwiceDiffersInNothing) {
  Ground a;
  Ground b;
  EXPECT_TRUE(compare(a.told(), b.told()).empty());
  EXPECT_EQ(b.told().bodies.size(), 3u);
  b.say(b.body("arm").find_part("tip")->id(), "friction", {0.5});
  EXPECT_FALSE(compare(a.told(), b.told()).empty()) << "said, though it is the default";
}

TEST(Difference, NamesTheRowsOfTheThingsThatDiffer) {
  Ground a;
  Ground b;
  Body& arm = b.body("arm");
  b.say(arm.find_part("lower")->id(), "friction", {0.25});
  b.say(arm.find_joint("elbow")->id(), "angular_lower_limit", {0, 0, -1});
  b.say(arm.find_motor("slide")->id(), "mode", {3});
  b.say(b.world.id(), "gravity", {0, 0, -1});
  const Difference d = compare(a.told(), b.told());
  EXPECT_EQ(d.world, bit(World::table().at("gravity").index));
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_EQ(b.told().bodies[d.bodies[0].now].name, "arm");
  EXPECT_FALSE(d.bodies[0].anew);
  EXPECT_EQ(d.bodies[0].parts, (std::vector<std::uint64_t>{0, 0, bit(Part::table().at("friction").index), 0}));
  EXPECT_EQ(d.bodies[0].joints,
            (std::vector<std::uint64_t>{0, bit(Joint::table().at("angular_lower_limit").index), 0}));
  // a mode is the flags behind it
  const auto flag = [](const char* name) { return bit(Motor::table().at(name).index); };
  EXPECT_EQ(d.bodies[0].motors[2], flag("linear_active") | flag("linear_servo_active") | flag("linear_spring_active"));
  EXPECT_FALSE(d.bodies[0].position || d.bodies[0].rotation || d.bodies[0].start);
}

TEST(Difference, KnowsWhoCameAndWent) {
  Ground a;
  Ground b;
  b.world.remove_body(b.body("1"));
  ASSERT_TRUE(b.world.add_body("new").ok());
  ASSERT_TRUE(b.world.add_shape("extra", ball()).ok());
  const Difference d = compare(a.told(), b.told());
  EXPECT_EQ(d.gone_bodies, std::vector<std::size_t>{1});
  EXPECT_EQ(d.bodies_before, (std::vector<std::optional<std::size_t>>{0, 2, std::nullopt}));
  EXPECT_TRUE(d.gone_shapes.empty());
  EXPECT_EQ(d.shapes_before.back(), std::nullopt);
  EXPECT_TRUE(d.bodies.empty()) << "the others are as they were";
}

TEST(Difference, AMovedBodyIsNoOtherMaking) {
  Ground a;
  Ground b;
  // turned and shifted: every number of every part is another one, and none of its making
  b.say(b.body("arm").id(), "rotation", {0, 0, 0.6, 0.8});
  b.say(b.body("arm").id(), "position", {3, -2, 1.7});
  const Difference d = compare(a.told(), b.told());
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_FALSE(d.bodies[0].anew);
  EXPECT_TRUE(d.bodies[0].position);
  EXPECT_TRUE(d.bodies[0].rotation);
  EXPECT_TRUE(d.bodies[0].start);
  EXPECT_TRUE(d.bodies[0].trees_along.empty());
}

TEST(Difference, AMovedPartOfAJointIsAnotherMaking) {
  Ground a;
  Ground b;
  b.say(b.body("arm").find_part("tip")->id(), "position", {0, 0, 2.6});
  const Difference d = compare(a.told(), b.told());
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_TRUE(d.bodies[0].anew);
  EXPECT_EQ(d.bodies[0].joints_start_anew, (std::vector<bool>{false, false, true}));
}

TEST(Apply, BringsAWorldToWhatIsTold) {
  Ground live;
  Ground draft;
  LiveThings things = things_of(live.world);
  for (int i = 0; i < 5; i++) live.world.step();
  Ground before;
  const Description last = before.told();
  draft.say(draft.body("arm").find_part("tip")->id(), "friction", {0.25});
  draft.world.remove_body(draft.body("1"));
  Body& extra = **draft.world.add_body("extra");
  ASSERT_TRUE(extra.add_part("p", *draft.world.find_shape("ball"), 2, {{9, 0, 0}, quat_identity()}).ok());
  const Description now = draft.told();
  const Difference difference = compare(last, now);
  std::vector<std::string> set;
  const NodeId tip = live.body("arm").find_part("tip")->id();
  const Part::Stance stance = live.body("arm").find_part("tip")->stance();
  apply({live.world, draft.world, last, now, difference,
         [&](NodeId id, const Row& r) { set.push_back(live.store.path(id) + "/" + r.name); }},
        things);
  EXPECT_EQ(set, std::vector<std::string>{"/physics/body/arm/part/tip/friction"});
  EXPECT_EQ(live.world.body_names(), (std::vector<std::string_view>{"arm", "floor", "extra"}));
  EXPECT_EQ(live.body("arm").find_part("tip")->id(), tip);
  EXPECT_EQ(live.body("arm").find_part("tip")->stance().transform, stance.transform);
  EXPECT_EQ(live.body("extra").root()->pose().position, Vec3(9, 0, 0));
  EXPECT_EQ(live.body("extra").root()->shape(), live.world.find_shape("ball")->id());
  EXPECT_EQ(things.bodies.size(), 3u);
  EXPECT_EQ(things.bodies[2], live.body("extra").id());
  // once more, and nothing is left to do
  const std::uint64_t hash = live.world.state_hash();
  const Difference none = compare(now, now);
  apply({live.world, draft.world, now, now, none}, things);
  EXPECT_EQ(live.world.state_hash(), hash);
}

}  // namespace
}  // namespace limber::engine_test
