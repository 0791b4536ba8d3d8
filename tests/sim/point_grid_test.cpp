// The grid against looking at every point: the same comparisons, in the same single precision, so exactly equal.
#include "sim/point_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace limber {
namespace {

/// A way to spread points.
struct Spread {
  const char* name;
  int points;
  std::function<float(std::mt19937&)> coordinate;
  int bodies;  // points a body
};

float uniform(std::mt19937& dice, float a, float b) { return std::uniform_real_distribution<float>(a, b)(dice); }

const std::vector<Spread>& spreads() {
  static const std::vector<Spread> all = {
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

PointCloud cloud_of(const Spread& spread) {
  std::mt19937 dice(11);
  PointCloud cloud;
  cloud.clear();
  for (int i = 0; i < spread.points; i++) {
    const float x = spread.coordinate(dice);
    const float y = spread.coordinate(dice);
    cloud.add(x, y, spread.coordinate(dice), i / spread.bodies);
  }
  cloud.one_each = spread.bodies == 1;
  return cloud;
}

bool within(const PointCloud& c, std::size_t i, const PointQuery& q, float least, float most) {
  const float dx = q.x - c.x[i], dy = q.y - c.y[i], dz = q.z - c.z[i];
  const float d = (dx * dx + dy * dy) + dz * dz;
  return d >= least * least && d <= most * most && c.body[i] != q.body;
}

constexpr float kDistances[] = {0, 1e-6f, 0.1f, 0.5f, 1, 1.7f, 4, 30, 2e4f};

/// Narrower ones than asked for where the processor has no such.
class PointGridLanes : public testing::TestWithParam<PointLanes> {};
INSTANTIATE_TEST_SUITE_P(All, PointGridLanes,
                         testing::Values(PointLanes::four, PointLanes::eight, PointLanes::sixteen));

TEST_P(PointGridLanes, FindsWhatLookingAtEveryPointFinds) {
  for (const Spread& spread : spreads()) {
    const PointCloud cloud = cloud_of(spread);
    std::vector<std::uint32_t> out(cloud.size() + kPointRoom);
    std::mt19937 dice(5);
    for (const float most : kDistances) {
      PointGrid grid(GetParam());
      grid.build(cloud, most);
      EXPECT_EQ(grid.size(), cloud.size());
      for (int q = 0; q < 60; q++) {
        // at the points themselves, near them, and anywhere
        PointQuery query{uniform(dice, -4, 4), uniform(dice, -4, 4), uniform(dice, -4, 4),
                         static_cast<int>(dice() % 5)};
        if (cloud.size() > 0 && q % 3 > 0) {
          const std::size_t i = dice() % cloud.size();
          const float off = q % 3 == 1 ? 0 : uniform(dice, -most, most);
          query = {cloud.x[i] + off, cloud.y[i], cloud.z[i] - off, cloud.body[i]};
        }
        for (const float least : {0.0f, most / 2}) {
          std::vector<std::uint32_t> wanted;
          for (std::uint32_t i = 0; i < cloud.size(); i++) {
            if (within(cloud, i, query, least, most)) wanted.push_back(i);
          }
          const std::uint32_t count = grid.near(query, least, most, out.data());
          std::vector<std::uint32_t> found;
          for (std::uint32_t k = 0; k < count; k++) found.push_back(grid.order()[out[k]]);
          std::sort(found.begin(), found.end());
          ASSERT_EQ(found, wanted) << spread.name << " within " << least << " .. " << most;
        }
      }
    }
  }
}

TEST_P(PointGridLanes, EachPairOnce) {
  for (const Spread& spread : spreads()) {
    const PointCloud cloud = cloud_of(spread);
    std::vector<std::uint32_t> out(cloud.size() + kPointRoom);
    for (const float most : kDistances) {
      PointGrid grid(GetParam());
      grid.build(cloud, most);
      for (const float least : {0.0f, most / 2}) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> wanted, found;
        for (std::uint32_t i = 0; i < cloud.size(); i++) {
          for (std::uint32_t j = i + 1; j < cloud.size(); j++) {
            if (within(cloud, j, {cloud.x[i], cloud.y[i], cloud.z[i], cloud.body[i]}, least, most))
              wanted.emplace_back(i, j);
          }
        }
        for (std::uint32_t place = 0; place < cloud.size(); place++) {
          const std::uint32_t count = grid.near_once(place, least, most, out.data());
          for (std::uint32_t k = 0; k < count; k++) {
            found.emplace_back(std::minmax(grid.order()[place], grid.order()[out[k]]));
          }
        }
        std::ranges::sort(found);
        ASSERT_EQ(found, wanted) << spread.name << " within " << least << " .. " << most;
      }
    }
  }
}

TEST(PointGrid, AnswersShorterDistancesThanItWasBuiltFor) {
  const PointCloud cloud = cloud_of(spreads()[0]);
  PointGrid grid;
  grid.build(cloud, 1.5f);
  EXPECT_EQ(grid.reach(), 1.5f);
  std::vector<std::uint32_t> out(cloud.size() + kPointRoom);
  for (std::uint32_t i = 0; i < 50; i++) {
    const PointQuery query{cloud.x[i], cloud.y[i], cloud.z[i], cloud.body[i]};
    std::uint32_t wanted = 0;
    for (std::size_t k = 0; k < cloud.size(); k++) wanted += within(cloud, k, query, 0, 0.8f) ? 1u : 0u;
    EXPECT_EQ(grid.near(query, 0, 0.8f, out.data()), wanted);
  }
}

TEST(PointGrid, MayBeBuiltAgain) {
  PointGrid grid;
  EXPECT_EQ(grid.size(), 0U);
  std::vector<std::uint32_t> out(700 + kPointRoom);
  for (const int which : {0, 7, 9, 3, 0}) {
    const PointCloud cloud = cloud_of(spreads()[static_cast<std::size_t>(which)]);
    grid.build(cloud, 1);
    std::uint32_t pairs = 0;
    std::uint32_t wanted = 0;
    for (std::uint32_t i = 0; i < cloud.size(); i++) {
      const PointQuery query{cloud.x[i], cloud.y[i], cloud.z[i], cloud.body[i]};
      pairs += grid.near(query, 0, 1, out.data());
      for (std::size_t k = 0; k < cloud.size(); k++) wanted += within(cloud, k, query, 0, 1) ? 1u : 0u;
    }
    EXPECT_EQ(pairs, wanted);
  }
}

}  // namespace
}  // namespace limber
