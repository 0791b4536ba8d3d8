// Pairs of parts of a body that don't collide: those that overlap at the start and those that a script excludes;
// independent of joints, collision groups and self_collision.
#include "sim/world/part_pairs.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/memory/page_store.h"
#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim {
namespace {

using namespace test;

std::vector<std::string> lines_since(std::uint64_t seen) {
  std::vector<std::string> lines;
  for (const LogLine& line : log_since(seen)) lines.push_back(line.text);
  return lines;
}

/// Two boxes of one body beside each other, 0.2 m each, with a gap between them (negative: overlap), without gravity.
struct TwoBoxes : WorldFixture {
  explicit TwoBoxes(double gap)
      : pair(body("pair")), a(part(pair, box_model(Vec3(0.2)), 1)), b(box_beside(pair, gap)) {}

  Part& box_beside(Body& body, double gap) {
    return part(body, box_model(Vec3(0.2)), 1, {{0.2 + gap, 0, 0}, quat_identity()});
  }
  /// Throws the boxes at each other from 0.4 m. Returns true if they pass through each other.
  bool throw_at_each_other() {
    b.set_pose({{0.6, 0, 0}, quat_identity()});
    a.set_pose({});
    a.set_velocity({1, 0, 0}, Vec3(0));
    b.set_velocity({-1, 0, 0}, Vec3(0));
    ticks(40);
    return a.pose().position.x > b.pose().position.x;
  }

  Body& pair;
  Part& a;
  Part& b;
};

TEST(PartPairs, OverlapAtTheFirstTickExcludes) {
  const std::pair<double, bool> cases[] = {{0.01, false}, {0, false}, {-0.00005, false}, {-0.0002, true}, {-0.1, true}};
  for (const auto& [gap, excluded] : cases) {
    TwoBoxes s(gap);
    EXPECT_TRUE(s.pair.pairs().list().empty()) << gap;  // not before the first tick
    s.ticks(1);
    EXPECT_EQ(s.pair.pairs().excludes(s.a, s.b), excluded) << gap;
    EXPECT_EQ(s.throw_at_each_other(), excluded) << gap;
  }
}

TEST(PartPairs, TouchingRotatedBoxesCollide) {
  for (int i = 0; i < 8; i++) {
    WorldFixture s;
    const Pose frame{{1.3 * i, -0.7 * i, 2}, quat_euler(0.4 * i, 1.1 * i, -0.3 * i)};
    Body& body = s.body("pair");
    Part& a = s.part(body, box_model(Vec3(0.2)), 1, frame);
    Part& b = s.part(body, box_model(Vec3(0.2)), 1, frame * Pose{{0.2, 0, 0}, quat_identity()});
    s.ticks(1);
    EXPECT_FALSE(body.pairs().excludes(a, b)) << i;
  }
}

// excluded boxes don't interact: penetration is not repaired
TEST(PartPairs, ExcludedPartsAreNotSeparated) {
  TwoBoxes s(-0.1);
  s.ticks(60);
  EXPECT_EQ(s.a.pose().position, Vec3(0));
  EXPECT_EQ(s.b.linear_velocity(), Vec3(0));
}

TEST(PartPairs, LaterOverlapsDoNotExclude) {
  TwoBoxes separate(0.3);
  separate.ticks(1);
  separate.b.set_pose({{0.1, 0, 0}, quat_identity()});
  separate.ticks(5);
  EXPECT_FALSE(separate.pair.pairs().excludes(separate.a, separate.b));
  EXPECT_GT(glm::length(separate.b.pose().position - separate.a.pose().position), 0.1);  // pushed apart
  TwoBoxes together(-0.1);
  together.ticks(1);
  together.b.set_pose({{5, 0, 0}, quat_identity()});
  together.ticks(5);
  EXPECT_TRUE(together.pair.pairs().excludes(together.a, together.b));
}

TEST(PartPairs, EditsActAtTheNextStep) {
  TwoBoxes s(0.01);
  s.ticks(1);
  ASSERT_TRUE(s.pair.pairs().edit(s.b, s.a, PairEdit::excluded).ok());
  EXPECT_TRUE(s.throw_at_each_other());
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::included).ok());
  EXPECT_FALSE(s.throw_at_each_other());
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::none).ok());
  EXPECT_TRUE(s.pair.pairs().list().empty());
  // also before the first tick: an overlap doesn't override an edit
  TwoBoxes early(-0.0005);
  ASSERT_TRUE(early.pair.pairs().edit(early.a, early.b, PairEdit::included).ok());
  early.ticks(1);
  EXPECT_FALSE(early.pair.pairs().excludes(early.a, early.b));
  ASSERT_TRUE(early.pair.pairs().edit(early.a, early.b, PairEdit::none).ok());
  EXPECT_TRUE(early.pair.pairs().excludes(early.a, early.b));
  EXPECT_TRUE(early.throw_at_each_other());
}

// an existing contact ends at the next step
TEST(PartPairs, ExcludingDropsTheContact) {
  WorldFixture s;
  s.gravity({0, 0, -10});
  Body& body = s.body("two");
  Part& table = s.part(body, box_model(Vec3(0.2)), 0);
  Part& box = s.part(body, box_model(Vec3(0.2)), 1, {{0, 0, 0.2}, quat_identity()});
  s.ticks(30);
  EXPECT_NEAR(box.pose().position.z, 0.2, 0.002);
  const double rest = box.pose().position.z;
  ASSERT_TRUE(body.pairs().edit(table, box, PairEdit::excluded).ok());
  s.ticks(6);
  EXPECT_NEAR(box.pose().position.z, rest - 10.0 / 240 / 240 * 24 * 25 / 2, 1e-5);
}

TEST(PartPairs, RejectsForeignParts) {
  TwoBoxes s(0.01);
  Part& other = s.add_single_part(sphere_model(0.1), 1);
  EXPECT_NE(s.pair.pairs().edit(s.a, other, PairEdit::excluded).error().find("of this body"), std::string::npos);
  EXPECT_NE(s.pair.pairs().edit(s.a, s.a, PairEdit::excluded).error().find("different"), std::string::npos);
}

// a joint and an exclusion are independent: neither cancels the other
TEST(PartPairs, JointsAndExclusionsAreIndependent) {
  TwoBoxes s(0.05);
  (void)s.pair.add_joint("j", s.a, s.b, model::JointType::floating, {0.1, 0, 0}, {0, 0, 1}).value();
  s.ticks(1);
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::excluded).ok());
  EXPECT_TRUE(s.throw_at_each_other());
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::included).ok());
  EXPECT_TRUE(s.throw_at_each_other()) << "the joint still keeps them apart";
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::excluded).ok());
  s.pair.joints().front()->remove_from_world();  // as when a body is removed from the world
  EXPECT_TRUE(s.throw_at_each_other()) << "the exclusion still does";
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::included).ok());
  EXPECT_FALSE(s.throw_at_each_other());
}

TEST(PartPairs, JointedPartsAreNotListed) {
  TwoBoxes s(-0.1);
  (void)s.pair.add_joint("j", s.a, s.b, model::JointType::revolute, {0.1, 0, 0}, {0, 0, 1}).value();
  s.ticks(1);
  EXPECT_TRUE(s.pair.pairs().list().empty());
}

TEST(PartPairs, CopiesKeepTheList) {
  TwoBoxes s(-0.0005);
  Part& c = s.part(s.pair, box_model(Vec3(0.2)), 1, {{0, 0.5, 0}, quat_identity()});
  s.ticks(1);
  ASSERT_TRUE(s.pair.pairs().edit(s.a, c, PairEdit::excluded).ok());
  Body& copy = **s.world.copy_body(s.pair, "copy");
  copy.set_pose({{0, 0, 3}, quat_identity()});
  s.ticks(1);
  EXPECT_TRUE(copy.pairs().excludes(*copy.parts()[0], *copy.parts()[1]));
  EXPECT_TRUE(copy.pairs().excludes(*copy.parts()[0], *copy.parts()[2]));
  EXPECT_FALSE(copy.pairs().excludes(*copy.parts()[1], *copy.parts()[2]));
  const Vec3 before = copy.parts()[1]->pose().position;
  s.ticks(30);
  EXPECT_EQ(copy.parts()[1]->pose().position, before);
}

TEST(PartPairs, ChecksPartsThatAreAddedLater) {
  TwoBoxes s(0.05);
  s.ticks(1);
  Part& c = s.part(s.pair, sphere_model(0.05), 1);
  s.ticks(1);
  EXPECT_TRUE(s.pair.pairs().excludes(s.a, c));
  EXPECT_FALSE(s.pair.pairs().excludes(s.b, c));
  EXPECT_FALSE(s.pair.pairs().excludes(s.a, s.b));
}

TEST(PartPairs, UndoRestoresThem) {
  TwoBoxes s(-0.0005);
  Part& far = s.part(s.pair, sphere_model(0.05), 1, {{0, 0, 9}, quat_identity()});
  ASSERT_TRUE(s.pair.pairs().edit(s.a, far, PairEdit::excluded).ok());
  s.ticks(1);
  const std::uint64_t hash = s.world.state_hash();
  s.world.transaction().begin();
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::included).ok());
  Part& c = s.part(s.pair, sphere_model(0.05), 1);
  ASSERT_TRUE(s.pair.pairs().edit(s.a, c, PairEdit::excluded).ok());
  ASSERT_TRUE(s.pair.pairs().edit(s.a, far, PairEdit::included).ok());
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::excluded).ok());
  s.world.transaction().rollback();
  EXPECT_EQ(s.world.state_hash(), hash);
  ASSERT_EQ(s.pair.pairs().list().size(), 2u);
  EXPECT_EQ(s.pair.pairs().list()[0].edit, PairEdit::none);
  EXPECT_TRUE(s.pair.pairs().excludes(s.a, far));
  EXPECT_TRUE(s.throw_at_each_other());
}

TEST(PartPairs, CheckpointsRestoreThem) {
  TwoBoxes s(-0.0005);
  s.ticks(2);
  PageStore pages;
  Archive scratch;
  WorldCheckpoint excluded, included;
  excluded.capture(s.world, pages, nullptr, scratch);
  ASSERT_TRUE(s.pair.pairs().edit(s.a, s.b, PairEdit::included).ok());
  included.capture(s.world, pages, nullptr, scratch);
  EXPECT_FALSE(s.throw_at_each_other());
  const std::uint64_t hash = s.world.state_hash();
  excluded.restore(s.world, pages, scratch);
  EXPECT_TRUE(s.pair.pairs().excludes(s.a, s.b));
  EXPECT_TRUE(s.throw_at_each_other());
  included.restore(s.world, pages, scratch);
  EXPECT_FALSE(s.throw_at_each_other());
  EXPECT_EQ(s.world.state_hash(), hash);
  excluded.release(pages);
  included.release(pages);
}

// one message for all bodies of a tick
TEST(PartPairs, OverlapsAreReportedOnce) {
  WorldFixture s;
  for (int i = 0; i < 10; i++) {
    Body& body = s.body("body" + std::to_string(i));
    s.part(body, sphere_model(0.1), 1, {{2.0 * i, 0, 0}, quat_identity()});
    s.part(body, sphere_model(0.1), 1, {{2.0 * i, 0, 0.199}, quat_identity()});
  }
  const std::uint64_t seen = log_newest();
  s.ticks(3);
  const std::vector<std::string> lines = lines_since(seen);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("overlap at the first tick (1 mm); excluded from collision … and 9 more of this kind"),
            std::string::npos)
      << lines[0];
}

// parts that don't collide anyway
TEST(PartPairs, OverlapsWithoutSelfCollisionAreNotReported) {
  WorldFixture s;
  Body& body = s.body("body");
  s.set(body.id(), "self_collision", {0});
  const Part& a = s.part(body, sphere_model(0.1), 1);
  const Part& b = s.part(body, sphere_model(0.1), 1, {{0, 0, 0.199}, quat_identity()});
  const std::uint64_t seen = log_newest();
  s.ticks(3);
  EXPECT_TRUE(lines_since(seen).empty());
  EXPECT_TRUE(body.pairs().excludes(a, b));  // also after self_collision is switched on
}

/// Throws two boxes of different bodies at each other. Returns true if they pass through each other.
bool different_bodies_pass(const std::function<void(WorldFixture&, Part&, Part&)>& prepare) {
  WorldFixture s;
  Part& a = s.add_single_part(box_model(Vec3(0.2)), 1);
  Part& b = s.add_single_part(box_model(Vec3(0.2)), 1, {{0.6, 0, 0}, quat_identity()});
  a.set_velocity({1, 0, 0}, Vec3(0));
  b.set_velocity({-1, 0, 0}, Vec3(0));
  prepare(s, a, b);
  s.ticks(40);
  return a.pose().position.x > b.pose().position.x;
}

TEST(CollisionGroups, BothMasksMustInclude) {
  const auto with = [](double group_a, double mask_a, double group_b, double mask_b) {
    return different_bodies_pass([=](WorldFixture& s, Part& a, Part& b) {
      s.set(a.id(), "collision_group", {group_a});
      s.set(a.id(), "collision_mask", {mask_a});
      s.set(b.id(), "collision_group", {group_b});
      s.set(b.id(), "collision_mask", {mask_b});
    });
  };
  EXPECT_FALSE(different_bodies_pass([](WorldFixture&, Part&, Part&) {}));
  EXPECT_FALSE(with(1, 65535, 1, 65535));
  EXPECT_FALSE(with(2, 4, 4, 2));
  EXPECT_FALSE(with(32768, 32768, 32768, 32768));
  EXPECT_FALSE(with(3, 8, 8, 2));
  EXPECT_TRUE(with(2, 65535, 4, 4));
  EXPECT_TRUE(with(2, 2, 4, 65535));
  EXPECT_TRUE(with(1, 65535, 1, 0));
  EXPECT_TRUE(with(0, 65535, 1, 65535));
}

TEST(CollisionGroups, CopiesKeepThem) {
  WorldFixture s;
  s.gravity({0, 0, -10});
  s.floor();
  Part& ghost = s.add_single_part(sphere_model(0.1), 1, {{0, 0, 0.1}, quat_identity()});
  s.set(ghost.id(), "collision_mask", {2});
  Body& copy = **s.world.copy_body(ghost.body(), "copy");
  copy.set_pose({{1, 0, 0.1}, quat_identity()});
  s.ticks(30);
  EXPECT_LT(ghost.pose().position.z, -0.5);
  EXPECT_LT(copy.pose().position.z, -0.5);
}

TEST(StaticParts, ReportAVelocity) {
  WorldFixture s;
  const std::uint64_t seen = log_newest();
  Part& floor = s.floor();
  s.ticks(1);
  s.set(floor.id(), "linear_velocity", {0, 0, 0});
  s.ticks(1);
  EXPECT_TRUE(lines_since(seen).empty());
  s.set(floor.id(), "linear_velocity", {1, 0, 0});
  s.ticks(1);
  s.set(floor.id(), "angular_velocity", {1, 0, 0});
  s.ticks(1);
  s.set(floor.body().id(), "linear_velocity", {1, 0, 0});
  s.ticks(1);
  const std::vector<std::string> lines = lines_since(seen);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("is a plane and can't move, so a velocity has no effect"), std::string::npos) << lines[0];
  EXPECT_EQ(floor.linear_velocity(), Vec3(0));
}

}  // namespace
}  // namespace limber::sim
