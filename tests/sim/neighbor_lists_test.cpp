// Neighbor lists: lists built for all parts at once equal the results of single queries.
#include "sim/neighbors/neighbor_lists.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace limber::sim {
namespace {

constexpr std::size_t kPoints = 400;

// Points in a cube of 4 m, two per body, of every second part.
struct Swarm {
  PointCloud cloud;
  PointGrid grid;
  std::vector<std::uint32_t> parts;

  Swarm() {
    cloud.clear();
    Random random(7);
    const auto coordinate = [&] { return static_cast<float>(random.uniform(0, 4)); };
    for (std::size_t i = 0; i < kPoints; i++) {
      const float x = coordinate(), y = coordinate();
      cloud.add(x, y, coordinate(), static_cast<std::int32_t>(i / 2));
      parts.push_back(static_cast<std::uint32_t>(2 * i));
    }
    grid.build(cloud, 1);
  }
  NeighborLists::Source source() { return {cloud, grid, parts, 2 * kPoints}; }

  std::vector<std::uint32_t> brute_force(std::size_t i, float radius) const {
    std::vector<std::uint32_t> near;
    for (std::size_t k = 0; k < kPoints; k++) {
      const float dx = cloud.x[i] - cloud.x[k], dy = cloud.y[i] - cloud.y[k], dz = cloud.z[i] - cloud.z[k];
      if (cloud.body[k] != cloud.body[i] && (dx * dx + dy * dy) + dz * dz <= radius * radius) near.push_back(parts[k]);
    }
    return near;
  }
};

TEST(NeighborLists, AreBuiltForAllIfMostAreQueried) {
  Swarm swarm;
  NeighborLists lists;
  // there were no queries before the first tick: each is answered separately
  for (const std::uint32_t part : swarm.parts) EXPECT_FALSE(lists.find(part, 1, swarm.source()).has_value());
  lists.invalidate();
  std::size_t neighbors = 0;
  for (std::size_t i = 0; i < kPoints; i++) {
    const auto found = lists.find(swarm.parts[i], 1, swarm.source());
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(std::vector<std::uint32_t>(found->begin(), found->end()), swarm.brute_force(i, 1)) << i;
    neighbors += found->size();
  }
  EXPECT_GT(neighbors, 10 * kPoints);
}

TEST(NeighborLists, FewQueriesAreAnsweredSeparately) {
  Swarm swarm;
  NeighborLists lists;
  for (int tick = 0; tick < 3; tick++) {
    for (std::uint32_t part = 0; part < 300; part += 2) EXPECT_FALSE(lists.find(part, 1, swarm.source()).has_value());
    lists.invalidate();
  }
}

TEST(NeighborLists, AreSeparateForEachRadius) {
  Swarm swarm;
  NeighborLists lists;
  for (int tick = 0; tick < 2; tick++) {
    for (const float radius : {0.5f, 1.0f}) {
      for (std::size_t i = 0; i < kPoints; i++) {
        const auto found = lists.find(swarm.parts[i], radius, swarm.source());
        ASSERT_EQ(found.has_value(), tick == 1);
        if (!found) continue;
        EXPECT_EQ(std::vector<std::uint32_t>(found->begin(), found->end()), swarm.brute_force(i, radius)) << i;
      }
    }
    lists.invalidate();
  }
}

}  // namespace
}  // namespace limber::sim
