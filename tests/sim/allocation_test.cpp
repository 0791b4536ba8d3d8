// Memory: ticks don't allocate, memory per part is bounded, and creating bodies wastes none.
#include <gtest/gtest.h>
#include <malloc.h>

#include "bench/raw/loop.h"
#include "sim/arm.h"
#include "sim/behavior/behavior_list.h"
#include "sim/counted_new.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

TEST(Allocation, TicksDoNotAllocate) {
  WorldFixture s;
  s.gravity({0, 0, -9.81});
  s.floor();
  Body& arm = make_arm(s, "arm1", {6, {0, 0, 0.05}});
  for (int i = 2; i <= 16; i++) {
    Body& copy = **s.world.copy_body(arm, "arm" + std::to_string(i));
    copy.set_pose({{0.7 * (i % 4), 0.7 * (i / 4), 0.05}, quat_identity()});
  }
  Part& ball = s.add_single_part(sphere_model(0.2), 1, {{-2, 0, 0.3}, quat_identity()});
  s.set(ball.id(), "report_contacts", {1});
  const Property& target = Motor::table().at("target");
  const auto tick = [&](int i) {
    // setting properties is part of a tick's work: every motor gets a new target
    const double value = 0.3 * std::sin(0.05 * i);
    for (const auto& body : s.world.bodies()) {
      for (const auto& motor : body->motors()) (void)s.store.set(motor->id(), target, {&value, 1});
      for (const auto& part : body->parts()) part->apply_force({0.1, 0, 0});
    }
    s.world.step();
  };
  for (int i = 0; i < 60; i++) tick(i);
  const std::size_t before = allocations();
  for (int i = 60; i < 160; i++) tick(i);
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_GT(before, 100u);  // the counter works
}

TEST(Allocation, RoutesAllocateNothingInATick) {
  WorldFixture s;
  Part& part = s.add_single_part(sphere_model(0.1), 1);
  const std::string path = s.store.path(part.id());
  Route& route = *s.world.behaviors().routes().add("route", "/physics/sim/time", path + "/linear_damping").value();
  s.set(route.id(), "smoothing", {0.1});
  s.set(route.id(), "lag", {0.1});
  ASSERT_TRUE(s.world.behaviors().routes().add("pattern", path + "/position", path + "/*_velocity").ok());
  s.ticks(10);
  const std::size_t before = allocations();
  s.ticks(30);
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_EQ(s.number(route.id(), "links"), 1);
}

TEST(Allocation, TendonsAllocateNothingInATick) {
  WorldFixture s;
  Body& body = s.body("mobile");
  s.set(body.id(), "self_collision", {0});
  std::vector<Tendon::Point> points;
  for (int i = 0; i < 8; i++)
    points.push_back(
        {&s.part(body, sphere_model(0.1), i == 0 ? 0 : 1, {{1.0 * i, 0, 0}, quat_identity()}), {0, 0, 0.1}});
  Tendon& tendon = *s.world.tendons().add(body, "tendon", std::move(points)).value();
  const auto tick = [&](int i) {
    s.set(tendon.id(), "tension", {1.0 + i % 3});
    s.world.step();
  };
  for (int i = 0; i < 30; i++) tick(i);
  const Property& tension = Tendon::table().at("tension");
  const std::size_t before = allocations();
  for (int i = 0; i < 30; i++) {
    const double value = 1.0 + i % 3;
    (void)s.store.set(tendon.id(), tension, {&value, 1});
    s.world.step();
  }
  EXPECT_EQ(allocations() - before, 0u);
  EXPECT_GT(s.number(tendon.id(), "force"), 0.5);
}

std::size_t used_memory() { return mallinfo2().uordblks + mallinfo2().hblkhd; }

// Memory of a link with a joint in a bare Bullet world.
double bytes_in_bullet(int arms, int links) {
  const auto memory_of = [&](int n) {
    const std::size_t before = used_memory();
    const RawLoop loop(ArmScene{.arms = n, .parts = links});
    return static_cast<double>(used_memory() - before);
  };
  return (memory_of(arms) - memory_of(1)) / ((arms - 1) * links);
}

// Sanitizers have their own malloc, which mallinfo doesn't report; under them this test passes trivially.
TEST(Allocation, MemoryPerPartIsBounded) {
  constexpr int kCopies = 200;
  constexpr int kLinks = 16;
  const double bullet_bytes = bytes_in_bullet(kCopies, kLinks);
  WorldFixture s;
  Body& arm = make_arm(s, "arm", {kLinks});
  s.ticks(1);
  const std::size_t before = used_memory();
  const std::size_t count = allocations();
  for (int i = 0; i < kCopies; i++) {
    Body& copy = **s.world.copy_body(arm, "arm" + std::to_string(i));
    copy.set_pose({{5.0 * (i + 1), 0, 0}, quat_identity()});
  }
  s.world.flush();
  EXPECT_LT(static_cast<double>(used_memory() - before) / (kCopies * kLinks) - bullet_bytes, 3000);
  const double news_per_part = static_cast<double>(allocations() - count) / (kCopies * kLinks);
  EXPECT_LT(news_per_part, 20);
  EXPECT_GT(news_per_part, 1);
}

}  // namespace
}  // namespace limber::sim
