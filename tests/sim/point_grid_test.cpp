// The grid compared with brute force: the same comparisons in the same single precision, so results must be equal.
#include "sim/neighbors/point_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "support/skip.h"

namespace limber::sim {
namespace {

/// A distribution of points.
struct PointDistribution {
  const char* name;
  int points;
  std::function<float(std::mt19937&)> coordinate;
  int bodies;  // points per body
};

float uniform(std::mt19937& generator, float a, float b) {
  return std::uniform_real_distribution<float>(a, b)(generator);
}

const std::vector<PointDistribution>& distributions() {
  static const std::vector<PointDistribution> all = {
      {"cube", 700, [](std::mt19937& d) { return uniform(d, -3, 3); }, 1},
      {"cube of bodies", 700, [](std::mt19937& d) { return uniform(d, -3, 3); }, 9},
      {"far from the origin", 300, [](std::mt19937& d) { return uniform(d, 5000, 5006); }, 3},
      {"one place", 90, [](std::mt19937&) { return 1.25f; }, 1},
      {"a lattice", 400, [](std::mt19937& d) { return static_cast<float>(static_cast<int>(d() % 8)); }, 2},
      {"a few outliers", 400,
       [](std::mt19937& d) { return d() % 50 == 0 ? uniform(d, -9e3f, 9e3f) : uniform(d, -2, 2); }, 1},
      {"tiny", 200, [](std::mt19937& d) { return uniform(d, 0, 1e-5f); }, 1},
      {"two", 2, [](std::mt19937& d) { return uniform(d, 0, 1); }, 1},
      {"one", 1, [](std::mt19937&) { return 0.0f; }, 1},
      {"none", 0, [](std::mt19937&) { return 0.0f; }, 1},
  };
  return all;
}

PointCloud cloud_of(const PointDistribution& distribution) {
  std::mt19937 generator(11);
  PointCloud cloud;
  cloud.clear();
  for (int i = 0; i < distribution.points; i++) {
    const float x = distribution.coordinate(generator);
    const float y = distribution.coordinate(generator);
    cloud.add(x, y, distribution.coordinate(generator), i / distribution.bodies);
  }
  cloud.one_per_body = distribution.bodies == 1;
  return cloud;
}

bool within(const PointCloud& c, std::size_t i, const PointQuery& q, float min_distance, float max_distance) {
  const float dx = q.x - c.x[i], dy = q.y - c.y[i], dz = q.z - c.z[i];
  const float d = (dx * dx + dy * dy) + dz * dz;
  return d >= min_distance * min_distance && d <= max_distance * max_distance && c.body[i] != q.body;
}

constexpr float kDistances[] = {0, 1e-6f, 0.1f, 0.5f, 1, 1.7f, 4, 30, 2e4f};

/// Parameter: the vector width, which PointGrid reduces if the processor doesn't support it.
class PointGridVectors : public testing::TestWithParam<VectorWidth> {};
INSTANTIATE_TEST_SUITE_P(All, PointGridVectors,
                         testing::Values(VectorWidth::four, VectorWidth::eight, VectorWidth::sixteen));

TEST_P(PointGridVectors, FindsTheSamePointsAsBruteForce) {
  LIMBER_SKIP_IF(kAddressSanitizer && GetParam() == VectorWidth::four, "the wider vectors use the same code");
  for (const PointDistribution& distribution : distributions()) {
    const PointCloud cloud = cloud_of(distribution);
    std::vector<std::uint32_t> out(cloud.size() + kPointPadding);
    std::mt19937 generator(5);
    for (const float max_distance : kDistances) {
      PointGrid grid(GetParam());
      grid.build(cloud, max_distance);
      EXPECT_EQ(grid.size(), cloud.size());
      for (int q = 0; q < 60; q++) {
        // at the points themselves, near them, and anywhere
        PointQuery query{uniform(generator, -4, 4), uniform(generator, -4, 4), uniform(generator, -4, 4),
                         static_cast<int>(generator() % 5)};
        if (cloud.size() > 0 && q % 3 > 0) {
          const std::size_t i = generator() % cloud.size();
          const float off = q % 3 == 1 ? 0 : uniform(generator, -max_distance, max_distance);
          query = {cloud.x[i] + off, cloud.y[i], cloud.z[i] - off, cloud.body[i]};
        }
        for (const float min_distance : {0.0f, max_distance / 2}) {
          std::vector<std::uint32_t> expected;
          for (std::uint32_t i = 0; i < cloud.size(); i++) {
            if (within(cloud, i, query, min_distance, max_distance)) expected.push_back(i);
          }
          const std::uint32_t count = grid.find_near(query, min_distance, max_distance, out.data());
          std::vector<std::uint32_t> found;
          for (std::uint32_t k = 0; k < count; k++) found.push_back(grid.order()[out[k]]);
          std::sort(found.begin(), found.end());
          ASSERT_EQ(found, expected) << distribution.name << " within " << min_distance << " .. " << max_distance;
        }
      }
    }
  }
}

TEST_P(PointGridVectors, FindsEachPairOnce) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  for (const PointDistribution& distribution : distributions()) {
    const PointCloud cloud = cloud_of(distribution);
    std::vector<std::uint32_t> out(cloud.size() + kPointPadding);
    for (const float max_distance : kDistances) {
      PointGrid grid(GetParam());
      grid.build(cloud, max_distance);
      for (const float min_distance : {0.0f, max_distance / 2}) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, found;
        for (std::uint32_t i = 0; i < cloud.size(); i++) {
          for (std::uint32_t j = i + 1; j < cloud.size(); j++) {
            if (within(cloud, j, {cloud.x[i], cloud.y[i], cloud.z[i], cloud.body[i]}, min_distance, max_distance))
              expected.emplace_back(i, j);
          }
        }
        for (std::uint32_t index = 0; index < cloud.size(); index++) {
          const std::uint32_t count = grid.find_pairs(index, min_distance, max_distance, out.data());
          for (std::uint32_t k = 0; k < count; k++) {
            found.emplace_back(std::minmax(grid.order()[index], grid.order()[out[k]]));
          }
        }
        std::ranges::sort(found);
        ASSERT_EQ(found, expected) << distribution.name << " within " << min_distance << " .. " << max_distance;
      }
    }
  }
}

TEST(PointGrid, SupportsShorterDistancesThanItsRadius) {
  const PointCloud cloud = cloud_of(distributions()[0]);
  PointGrid grid;
  grid.build(cloud, 1.5f);
  EXPECT_EQ(grid.search_radius(), 1.5f);
  std::vector<std::uint32_t> out(cloud.size() + kPointPadding);
  for (std::uint32_t i = 0; i < 50; i++) {
    const PointQuery query{cloud.x[i], cloud.y[i], cloud.z[i], cloud.body[i]};
    std::uint32_t wanted = 0;
    for (std::size_t k = 0; k < cloud.size(); k++) wanted += within(cloud, k, query, 0, 0.8f) ? 1u : 0u;
    EXPECT_EQ(grid.find_near(query, 0, 0.8f, out.data()), wanted);
  }
}

TEST(PointGrid, CanBeRebuilt) {
  PointGrid grid;
  EXPECT_EQ(grid.size(), 0U);
  std::vector<std::uint32_t> out(700 + kPointPadding);
  for (const int which : {0, 7, 9, 3, 0}) {
    const PointCloud cloud = cloud_of(distributions()[static_cast<std::size_t>(which)]);
    grid.build(cloud, 1);
    std::uint32_t pairs = 0;
    std::uint32_t expected = 0;
    for (std::uint32_t i = 0; i < cloud.size(); i++) {
      const PointQuery query{cloud.x[i], cloud.y[i], cloud.z[i], cloud.body[i]};
      pairs += grid.find_near(query, 0, 1, out.data());
      for (std::size_t k = 0; k < cloud.size(); k++) expected += within(cloud, k, query, 0, 1) ? 1u : 0u;
    }
    EXPECT_EQ(pairs, expected);
  }
}

}  // namespace
}  // namespace limber::sim
