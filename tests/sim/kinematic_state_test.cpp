// Kinematic parts, conveyors and motors with torques: checkpoints, threads and rollback.
#include <functional>
#include <memory>
#include <vector>

#include "base/threads/thread_pool.h"
#include "sim/motion/part_motion.h"
#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim::test {
namespace {

// Platforms moved by poses and velocities, with crates, a conveyor, a kinematic root with an arm, and a part that is
// switched while it moves.
struct MovingStage {
  explicit MovingStage(World& to) : world(to), store(to.store()) {
    set(world.id(), "gravity", {0, 0, -9.81});
    for (int i = 0; i < 6; i++) {
      Part& deck = add("deck" + std::to_string(i), {1, 1, 0.1}, 0, {2.0 * i, 0, 0});
      decks.push_back(&deck);
      if (i % 2 == 0) set(deck.id(), "motion", {1});
      for (int k = 0; k < 3; k++)
        add("crate" + std::to_string(3 * i + k), Vec3(0.2), 1, {2.0 * i, 0.25 * k - 0.25, 0.15});
    }
    Body& robot = **world.add_body("robot");
    root = *robot.add_part("root", box({0.1, 0.1, 0.1}), 1, {{0, 3, 1}, quat_identity()});
    arm = *robot.add_part("arm", box({0.6, 0.1, 0.1}), 1, {{0.35, 3, 1}, quat_identity()});
    Joint& joint = **robot.add_joint("joint", *root, *arm, model::JointType::revolute, {0.05, 3, 1}, {0, 1, 0});
    motor = *robot.add_motor(joint);
    set(joint.id(), "armature", {0.1});
    set(motor->id(), "mode", {4});
    set(root->id(), "motion", {1});
  }
  void set(NodeId id, const char* property, const std::vector<double>& values) {
    ASSERT_TRUE(store.set(id, property, values).ok()) << property;
  }
  Shape& box(const Vec3& size) { return **world.shapes().add("box" + std::to_string(count++), box_model(size)); }
  Part& add(const std::string& name, const Vec3& size, double mass, const Vec3& at) {
    return **(*world.add_body(name))->add_part("part", box(size), mass, {at, quat_identity()});
  }
  void play(int ticks) {
    for (int i = 0; i < ticks; i++) {
      const auto tick = world.tick();
      const double t = static_cast<double>(tick) / 60;
      const auto place = [&](int deck, const Vec3& offset, double turn) {
        decks[static_cast<std::size_t>(deck)]->set_pose({Vec3(2.0 * deck, 0, 0) + offset, quat_axis({0, 0, 1}, turn)});
      };
      place(0, {0.2 * std::sin(t), 0, 0}, 0);
      place(1, {0, 0, 0.1 * std::sin(2 * t)}, 0);
      place(2, {0, 0, 0}, 0.5 * t);
      if (tick == 20) set(decks[3]->id(), "angular_velocity", {0, 0, 0.4});
      if (tick == 30) set(decks[4]->id(), "linear_velocity", {0.1, 0, 0.05});
      if (tick == 25) set(decks[5]->id(), "surface_velocity", {0.3, 0, 0});
      if (tick == 75) set(decks[5]->id(), "surface_velocity", {0, 0, 0});
      root->set_pose({{0.3 * std::sin(3 * t), 3, 1}, quat_identity()});
      set(motor->id(), "target_torque", {std::sin(t)});
      if (tick == 60) set(root->id(), "motion", {0});
      if (tick == 70) set(root->id(), "motion", {1});
      world.step();
    }
  }

  World& world;
  Store& store;
  std::vector<Part*> decks;
  Part* root = nullptr;
  Part* arm = nullptr;
  Motor* motor = nullptr;
  int count = 0;
};

std::vector<std::uint64_t> stage_hashes(MovingStage& stage, int ticks) {
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < ticks; i++) {
    stage.play(1);
    hashes.push_back(stage.world.state_hash());
  }
  return hashes;
}

TEST(KinematicState, IsRestoredInTheMiddleOfMotions) {
  for (const int start : {10, 40, 65}) {
    WorldFixture s;
    MovingStage stage(s.world);
    stage.play(start);
    PageStore pages;
    Archive scratch;
    WorldCheckpoint checkpoint;
    checkpoint.capture(s.world, pages, nullptr, scratch);
    const std::vector<std::uint64_t> first = stage_hashes(stage, 60);
    checkpoint.restore(s.world, pages, scratch);
    EXPECT_EQ(stage_hashes(stage, 60), first) << start;
    checkpoint.release(pages);
  }
}

TEST(KinematicState, IsEqualForAnyNumberOfThreads) {
  std::vector<std::uint64_t> expected;
  for (const int threads : {1, 2, 4}) {
    Store store;
    WorldSetup setup;
    if (threads > 1) setup.thread_pool = std::make_shared<ThreadPool>(threads);
    World world(store, setup);
    MovingStage stage(world);
    const std::vector<std::uint64_t> hashes = stage_hashes(stage, 100);
    if (expected.empty()) expected = hashes;
    EXPECT_EQ(hashes, expected) << threads;
  }
}

// A guarded call that fails leaves no trace of the pose, velocity and motion that it set.
TEST(KinematicState, IsRolledBack) {
  std::vector<std::uint64_t> hashes;
  for (const bool fails : {false, true}) {
    WorldFixture s;
    MovingStage stage(s.world);
    stage.play(40);
    if (fails) {
      s.world.transaction().begin();
      stage.decks[4]->set_velocity({9, 0, 0}, {0, 0, 9});
      stage.decks[4]->flush();
      teleport_part(*stage.decks[0], {{0, 0, 3}, quat_identity()});
      stage.decks[0]->flush();
      stage.set(stage.arm->id(), "motion", {2});
      stage.set(stage.decks[5]->id(), "surface_velocity", {2, 0, 0});
      s.world.transaction().rollback();
    }
    stage.play(40);
    hashes.push_back(s.world.state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// The hash tells a kinematic part from a static one.
TEST(KinematicState, IsInTheHash) {
  WorldFixture s;
  Part& block = s.add_single_part(box_model(Vec3(1)), 0);
  const std::uint64_t before = s.world.state_hash();
  s.set(block.id(), "motion", {1});
  EXPECT_NE(s.world.state_hash(), before);
  s.set(block.id(), "motion", {2});
  EXPECT_EQ(s.world.state_hash(), before);
}

}  // namespace
}  // namespace limber::sim::test
