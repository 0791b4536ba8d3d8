// Sums over pairs: against sums in double precision, and to the bit the same by all lanes.
#include "sim/neighbor_sums.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace limber {
namespace {

constexpr std::uint32_t kSummed = 60;

std::vector<NeighborMotion> moving_points() {
  std::mt19937 dice(3);
  std::uniform_real_distribution<float> any(-5, 5);
  std::vector<NeighborMotion> points(kSummed);
  for (NeighborMotion& point : points) {
    for (int a = 0; a < 3; a++) {
      point.position[a] = any(dice);
      point.velocity[a] = dice() % 7 == 0 ? 0.0f : any(dice);
      point.spin[a] = any(dice);
    }
    point.position[3] = 1;
  }
  return points;
}

// some of those behind each
std::vector<std::uint32_t> found_by(std::uint32_t place) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t other = place + 1; other < kSummed; other++) {
    if ((place * 31 + other * 17) % 5 < 2) found.push_back(other);
  }
  return found;
}

std::vector<NeighborSum> sums_by(PointLanes lanes, bool motions) {
  const std::vector<NeighborMotion> points = moving_points();
  std::vector<NeighborSum> sums(kSummed);
  const AddPairs add = add_pairs_by(lanes, motions);
  for (std::uint32_t place = 0; place < kSummed; place++) add(place, found_by(place), points.data(), sums.data());
  return sums;
}

TEST(NeighborSums, AreOverBothOfEachPair) {
  const std::vector<NeighborMotion> points = moving_points();
  std::vector<std::vector<std::uint32_t>> near(kSummed);
  for (std::uint32_t place = 0; place < kSummed; place++) {
    for (const std::uint32_t other : found_by(place)) {
      near[place].push_back(other);
      near[other].push_back(place);
    }
  }
  const std::vector<NeighborSum> sums = sums_by(PointFinder::widest(), true);
  for (std::uint32_t place = 0; place < kSummed; place++) {
    EXPECT_EQ(sums[place].offset[3], static_cast<float>(near[place].size()));
    for (int a = 0; a < 3; a++) {
      double offset = 0, velocity = 0, spin = 0;
      for (const std::uint32_t other : near[place]) {
        offset += double{points[other].position[a]} - points[place].position[a];
        velocity += points[other].velocity[a];
        spin += points[other].spin[a];
      }
      EXPECT_NEAR(sums[place].offset[a], offset, 1e-4);
      EXPECT_NEAR(sums[place].velocity[a], velocity, 1e-4);
      EXPECT_NEAR(sums[place].spin[a], spin, 1e-4);
    }
  }
}

TEST(NeighborSums, AreTheSameToTheBitByAllLanes) {
  const std::vector<NeighborSum> plain = sums_by(PointLanes::four, true);
  for (const PointLanes lanes : {PointLanes::eight, PointLanes::sixteen}) {
    const std::vector<NeighborSum> wide = sums_by(lanes, true);
    EXPECT_EQ(std::memcmp(wide.data(), plain.data(), kSummed * sizeof(NeighborSum)), 0);
  }
  const std::vector<NeighborSum> still = sums_by(PointLanes::four, false);
  for (std::uint32_t place = 0; place < kSummed; place++) {
    EXPECT_EQ(std::memcmp(still[place].offset, plain[place].offset, sizeof still[place].offset), 0) << place;
  }
}

}  // namespace
}  // namespace limber
