// Sums over pairs: compared with sums in double precision, and bit for bit between all vector widths.
#include "sim/neighbors/neighbor_sums.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace limber::sim {
namespace {

constexpr std::uint32_t kPointCount = 60;

std::vector<NeighborMotion> moving_points() {
  std::mt19937 dice(3);
  std::uniform_real_distribution<float> any(-5, 5);
  std::vector<NeighborMotion> points(kPointCount);
  for (NeighborMotion& point : points) {
    for (int a = 0; a < 3; a++) {
      point.position[a] = any(dice);
      point.velocity[a] = dice() % 7 == 0 ? 0.0f : any(dice);
      point.angular_velocity[a] = any(dice);
    }
    point.position[3] = 1;
  }
  return points;
}

// Selects some of the points behind each point.
std::vector<std::uint32_t> neighbors_of(std::uint32_t index) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t other = index + 1; other < kPointCount; other++) {
    if ((index * 31 + other * 17) % 5 < 2) found.push_back(other);
  }
  return found;
}

std::vector<NeighborSum> sums_by(VectorWidth width, bool motions) {
  const std::vector<NeighborMotion> points = moving_points();
  std::vector<NeighborSum> sums(kPointCount);
  const AddPairs add = select_add_pairs(width, motions);
  for (std::uint32_t index = 0; index < kPointCount; index++)
    add(index, neighbors_of(index), points.data(), sums.data());
  return sums;
}

TEST(NeighborSums, IncludeBothPointsOfEachPair) {
  const std::vector<NeighborMotion> points = moving_points();
  std::vector<std::vector<std::uint32_t>> near(kPointCount);
  for (std::uint32_t index = 0; index < kPointCount; index++) {
    for (const std::uint32_t other : neighbors_of(index)) {
      near[index].push_back(other);
      near[other].push_back(index);
    }
  }
  const std::vector<NeighborSum> sums = sums_by(PointFinder::widest(), true);
  for (std::uint32_t index = 0; index < kPointCount; index++) {
    EXPECT_EQ(sums[index].offset[3], static_cast<float>(near[index].size()));
    for (int a = 0; a < 3; a++) {
      double offset = 0, velocity = 0, angular_velocity = 0;
      for (const std::uint32_t other : near[index]) {
        offset += double{points[other].position[a]} - points[index].position[a];
        velocity += points[other].velocity[a];
        angular_velocity += points[other].angular_velocity[a];
      }
      EXPECT_NEAR(sums[index].offset[a], offset, 1e-4);
      EXPECT_NEAR(sums[index].velocity[a], velocity, 1e-4);
      EXPECT_NEAR(sums[index].angular_velocity[a], angular_velocity, 1e-4);
    }
  }
}

TEST(NeighborSums, AreEqualForAllVectorWidths) {
  const std::vector<NeighborSum> plain = sums_by(VectorWidth::four, true);
  for (const VectorWidth width : {VectorWidth::eight, VectorWidth::sixteen}) {
    const std::vector<NeighborSum> wide = sums_by(width, true);
    EXPECT_EQ(std::memcmp(wide.data(), plain.data(), kPointCount * sizeof(NeighborSum)), 0);
  }
  const std::vector<NeighborSum> still = sums_by(VectorWidth::four, false);
  for (std::uint32_t index = 0; index < kPointCount; index++) {
    EXPECT_EQ(std::memcmp(still[index].offset, plain[index].offset, sizeof still[index].offset), 0) << index;
  }
}

}  // namespace
}  // namespace limber::sim
