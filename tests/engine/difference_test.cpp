// Scene diffs and how they are applied: worlds built by the test, without a scene.
#include "engine/reload/scene_diff.h"

#include "engine/reload/scene_patch.h"
#include "engine/rig.h"

namespace limber::engine::test {
namespace {

constexpr std::uint64_t bit(std::uint32_t property) { return std::uint64_t{1} << property; }

SpecValue spec_value(std::uint32_t number, bool is_set, double value) { return {number, is_set, {value, 0, 0, 0}}; }

TEST(SceneDiff, ComparesValueAndExplicitlySet) {
  const SpecValues nothing;
  const SpecValues by_default{spec_value(3, false, 1)};
  const SpecValues explicitly_set{spec_value(3, true, 1)};
  const SpecValues other{spec_value(3, true, 2)};
  const SpecValues other_default{spec_value(3, false, 2)};
  EXPECT_EQ(changed_mask(nothing, nothing), 0u);
  EXPECT_EQ(changed_mask(explicitly_set, explicitly_set), 0u);
  EXPECT_EQ(changed_mask(by_default, by_default), 0u);
  EXPECT_EQ(changed_mask(explicitly_set, other), bit(3));
  EXPECT_EQ(changed_mask(by_default, other_default), bit(3)) << "another default";
  EXPECT_EQ(changed_mask(by_default, explicitly_set), bit(3)) << "explicitly set for the first time";
  EXPECT_EQ(changed_mask(explicitly_set, by_default), bit(3)) << "no longer set";
  EXPECT_EQ(changed_mask(nothing, explicitly_set), bit(3));
  EXPECT_EQ(changed_mask(explicitly_set, nothing), bit(3));
  const SpecValues before{spec_value(1, true, 0), spec_value(4, true, 0), spec_value(7, true, 0)};
  const SpecValues now{spec_value(2, true, 0), spec_value(4, true, 0), spec_value(7, true, 1)};
  EXPECT_EQ(changed_mask(before, now), bit(1) | bit(2) | bit(7));
}

// a world that a test changes a little before its spec is captured
struct TestWorld {
  Store store;
  sim::World world;
  TestWorld() : world(store) { build_bodies(world); }

  sim::Body& body(const char* name) { return *world.find_body(name); }
  template <std::size_t N>
  void set_explicitly(NodeId id, const char* property, const double (&values)[N]) {
    const Store::ExplicitSetScope scope(store, true);
    ASSERT_TRUE(store.set(id, property, values).ok());
  }
  SceneSpec spec() {
    sim::flush_detached(world);
    return describe(world);
  }
};

TEST(SceneDiff, IsEmptyForEqualWorlds) {
  TestWorld a;
  TestWorld b;
  EXPECT_TRUE(compare(a.spec(), b.spec()).empty());
  EXPECT_EQ(b.spec().bodies.size(), 3u);
  b.set_explicitly(b.body("arm").find_part("tip")->id(), "friction", {0.5});
  EXPECT_FALSE(compare(a.spec(), b.spec()).empty()) << "explicitly set, though to the default";
}

TEST(SceneDiff, NamesTheDifferentPropertiesOfEachObject) {
  TestWorld a;
  TestWorld b;
  sim::Body& arm = b.body("arm");
  b.set_explicitly(arm.find_part("lower")->id(), "friction", {0.25});
  b.set_explicitly(arm.find_joint("elbow")->id(), "angular_lower_limit", {0, 0, -1});
  b.set_explicitly(arm.find_motor("slide")->id(), "mode", {3});
  b.set_explicitly(b.world.id(), "gravity", {0, 0, -1});
  const SceneDiff d = compare(a.spec(), b.spec());
  EXPECT_EQ(d.singles[kWorldNode], bit(sim::World::table().at("gravity").index));
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_EQ(b.spec().bodies[d.bodies[0].new_index].name, "arm");
  EXPECT_FALSE(d.bodies[0].rebuild);
  const std::uint64_t friction = bit(sim::Part::table().at("friction").index);
  const std::uint64_t limit = bit(sim::Joint::table().at("angular_lower_limit").index);
  // a mode is stored as flags
  const auto flag = [](const char* name) { return bit(sim::Motor::table().at(name).index); };
  const std::uint64_t mode = flag("linear_active") | flag("linear_servo_active") | flag("linear_spring_active");
  // the body, four parts, three joints, three motors
  EXPECT_EQ(d.bodies[0].changed, (std::vector<std::uint64_t>{0, 0, 0, friction, 0, 0, limit, 0, 0, 0, mode}));
  EXPECT_FALSE(d.bodies[0].position_changed || d.bodies[0].rotation_changed || d.bodies[0].start_changed);
}

TEST(SceneDiff, FindsAddedAndRemovedObjects) {
  TestWorld a;
  TestWorld b;
  b.world.remove_body(b.body("1"));
  ASSERT_TRUE(b.world.add_body("new").ok());
  ASSERT_TRUE(b.world.shapes().add("extra", ball()).ok());
  const SceneDiff d = compare(a.spec(), b.spec());
  EXPECT_EQ(d.removed_bodies, std::vector<std::size_t>{1});
  EXPECT_EQ(d.old_body_indices, (std::vector<std::optional<std::size_t>>{0, 2, std::nullopt}));
  EXPECT_TRUE(d.removed_shapes.empty());
  EXPECT_EQ(d.old_shape_indices.back(), std::nullopt);
  EXPECT_TRUE(d.bodies.empty()) << "the others are unchanged";
}

TEST(SceneDiff, AMovedBodyIsNotRebuilt) {
  TestWorld a;
  TestWorld b;
  // turned and shifted: all numbers of all parts differ, but not the construction
  b.set_explicitly(b.body("arm").id(), "rotation", {0, 0, 0.6, 0.8});
  b.set_explicitly(b.body("arm").id(), "position", {3, -2, 1.7});
  const SceneDiff d = compare(a.spec(), b.spec());
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_FALSE(d.bodies[0].rebuild);
  EXPECT_TRUE(d.bodies[0].position_changed);
  EXPECT_TRUE(d.bodies[0].rotation_changed);
  EXPECT_TRUE(d.bodies[0].start_changed);
  EXPECT_TRUE(d.bodies[0].trees_with_root.empty());
}

TEST(SceneDiff, ABodyWithAMovedJointPartIsRebuilt) {
  TestWorld a;
  TestWorld b;
  b.set_explicitly(b.body("arm").find_part("tip")->id(), "position", {0, 0, 2.6});
  const SceneDiff d = compare(a.spec(), b.spec());
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_TRUE(d.bodies[0].rebuild);
  EXPECT_EQ(d.bodies[0].joints_to_reset, (std::vector<bool>{false, false, true}));
}

TEST(ScenePatch, MakesTheWorldEqualToTheSpec) {
  TestWorld live;
  TestWorld candidate;
  LiveObjects objects = live_objects_of(live.world);
  for (int i = 0; i < 5; i++) live.world.step();
  TestWorld before;
  const SceneSpec last = before.spec();
  candidate.set_explicitly(candidate.body("arm").find_part("tip")->id(), "friction", {0.25});
  candidate.world.remove_body(candidate.body("1"));
  sim::Body& extra = **candidate.world.add_body("extra");
  ASSERT_TRUE(extra.add_part("p", *candidate.world.shapes().find("ball"), 2, {{9, 0, 0}, quat_identity()}).ok());
  const SceneSpec now = candidate.spec();
  const SceneDiff diff = compare(last, now);
  std::vector<std::string> set;
  const NodeId tip = live.body("arm").find_part("tip")->id();
  const sim::Part::Motion state = live.body("arm").find_part("tip")->capture_motion();
  apply({live.world, candidate.world, last, now, diff,
         [&](NodeId id, const Property& r) { set.push_back(live.store.path(id) + "/" + r.name); }},
        objects);
  EXPECT_EQ(set, std::vector<std::string>{"/physics/body/arm/part/tip/friction"});
  EXPECT_EQ(live.world.body_names(), (std::vector<std::string_view>{"arm", "floor", "extra"}));
  EXPECT_EQ(live.body("arm").find_part("tip")->id(), tip);
  EXPECT_EQ(live.body("arm").find_part("tip")->capture_motion().bullet_pose, state.bullet_pose);
  EXPECT_EQ(live.body("extra").root()->pose().position, Vec3(9, 0, 0));
  EXPECT_EQ(live.body("extra").root()->shape(), live.world.shapes().find("ball")->id());
  EXPECT_EQ(objects.bodies.size(), 3u);
  EXPECT_EQ(objects.bodies[2], live.body("extra").id());
  // applied once more it changes nothing
  const std::uint64_t hash = live.world.state_hash();
  const SceneDiff none = compare(now, now);
  apply({live.world, candidate.world, now, now, none}, objects);
  EXPECT_EQ(live.world.state_hash(), hash);
}

}  // namespace
}  // namespace limber::engine::test
