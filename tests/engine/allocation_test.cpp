// A tick does not allocate: with an empty scene, and with one that steps and receives values.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "engine/behaviors.h"
#include "engine/edited.h"
#include "engine/show.h"
#include "support/policy_files.h"

namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

// the whole test program allocates through these; inlined, g++ would see malloc and delete as a mismatched pair
[[gnu::noinline]] void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new[](std::size_t size) { return operator new(size); }
// standard algorithms that can do without a buffer ask for it without an exception
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(size > 0 ? size : 1);
}
[[gnu::noinline]] void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
  return operator new(size, tag);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete[](void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

namespace limber::engine::test {
namespace {

std::size_t allocations_during(Show& show, int ticks) {
  // fill the pools, the list of bodies and the history
  show.send("/physics/sim/history", 1);
  show.ticks(250);
  const std::size_t before = allocations.load();
  show.ticks(ticks);
  return allocations.load() - before;
}

TEST(EngineAllocation, NoneInAnEmptyWorld) {
  Show show;
  EXPECT_EQ(allocations_during(show, 200), 0U);
}

TEST(EngineAllocation, NoneWithBodiesAndRetainedSnapshots) {
  Show show;
  build_bodies(show.engine.world());
  // a reader that keeps two snapshots at any time, as a stream and a window do
  std::shared_ptr<const Snapshot> older;
  std::shared_ptr<const Snapshot> newer;
  const auto tick = [&] {
    show.engine.tick();
    older = std::move(newer);
    newer = show.link.snapshots.read();
  };
  show.send("/physics/sim/history", 1);
  for (int i = 0; i < 250; i++) tick();
  const std::size_t before = allocations.load();
  for (int i = 0; i < 200; i++) tick();
  EXPECT_EQ(allocations.load() - before, 0U);
}

TEST(EngineAllocation, NoneWithASceneThatSteps) {
  const SceneFile scene(R"(
local body = sim:add_body("ball")
local part = body:add_part("ball", sim:add_sphere_shape("ball", 0.1))
sim:on_step(function(dt) part:apply_force(vec3(0, 0, 9.81)) end)
)");
  Show show(scene.path());
  EXPECT_EQ(allocations_during(show, 200), 0U);
}

TEST(EngineAllocation, NoneWithAPolicy) {
  const ShowFolder folder;
  Random random(1, "policy");
  limber::test::SafetensorsWriter policy;
  policy.add("weight_ih_l0", limber::test::random_tensor(random, {120, 8}));
  policy.add("weight_hh_l0", limber::test::random_tensor(random, {120, 40}));
  policy.add("0.weight", limber::test::random_tensor(random, {3, 40}));
  folder.write("scripts/walk.safetensors", policy.bytes());
  folder.write("scripts/scene.lua", R"(
local policy = sim:load_policy("walk.safetensors")
local part = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1))
local observations, actions = { 0, 0, 0, 0, 0, 0, 0, 1 }, {}
sim:on_step(function()
  observations[1] = part.position.z
  policy:evaluate(observations, actions)
  part:apply_force(vec3(actions[1], actions[2], 9.81))
end)
)");
  Show show(folder.path("scripts/scene.lua"));
  EXPECT_EQ(allocations_during(show, 200), 0U);
}

TEST(EngineAllocation, NoneWhileMorphsRun) {
  const SceneFile scene(kEveryBehavior);
  Show show(scene.path());
  show.send("/physics/part/friction", 0.9);
  show.send("/physics/part/mass", 3);
  show.send("/preset/store", "heavy", "/physics/body/*/part//*");
  show.send("/preset/recall", "script");
  show.ticks(1);
  show.engine.finish_saving();  // on its own thread
  show.send("/preset/recall", "heavy", 60);
  EXPECT_EQ(allocations_during(show, 300), 0U);
  EXPECT_GT(show.read("/preset/progress"), 0.05) << "it is still running";
  EXPECT_LT(show.read("/preset/progress"), 0.5);
}

TEST(EngineAllocation, NoneWithEveryTypeOfBehavior) {
  const SceneFile scene(kEveryBehavior);
  Show show(scene.path());
  EXPECT_EQ(allocations_during(show, 300), 0U);
}

// the debug overlay is written into existing snapshots
TEST(EngineAllocation, NoneWithTheDebugOverlay) {
  const SceneFile scene(kEveryBehavior);
  Show show(scene.path());
  show.send("/visuals/look/overlay", 1);
  EXPECT_EQ(allocations_during(show, 300), 0U);
  EXPECT_GT(show.link.snapshots.read()->overlay.size(), 100U);
}

TEST(EngineAllocation, NoneForAReceivedValueExceptItsMessage) {
  Show show;
  build_bodies(show.engine.world());
  sim::World& world = show.engine.world();
  MessageDispatcher dispatch(world);
  const Message by_name = message("/physics/motor/angularservoposition", "arm", "elbow", 0.5);
  const Message to_all = message("/physics/part/friction", 0.5);
  const Message by_path = message("/physics/body/arm/motor/elbow/target", 0.25);
  const auto send = [&] {
    for (const Message* m : {&by_name, &to_all, &by_path}) EXPECT_EQ(dispatch.execute(*m).kind, Outcome::Kind::applied);
    world.step();
  };
  for (int i = 0; i < 10; i++) send();
  const std::size_t before = allocations.load();
  for (int i = 0; i < 100; i++) send();
  EXPECT_EQ(allocations.load() - before, 0U);
}

}  // namespace
}  // namespace limber::engine::test
