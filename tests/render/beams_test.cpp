// Beams: the geometry of the cone.
#include "ui/render/beams.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limber::render {
namespace {

TEST(Beams, AConeHasTheAngleOfTheBeamAndFades) {
  engine::Beam beam;
  beam.origin = {1, 2, 3};
  beam.direction = normalized(Vec3(1, -2, -2));
  beam.light = {1, 0.5, 0};
  beam.angle = 0.5;
  std::vector<BeamVertex> triangles;
  add_beam(beam, triangles);
  ASSERT_GT(triangles.size(), 100u);
  ASSERT_EQ(triangles.size() % 3, 0u);
  double brightness_near = 0;
  for (const BeamVertex& v : triangles) {
    const Vec3 at = Vec3(v.corner[0], v.corner[1], v.corner[2]) - beam.origin;
    const double along = glm::dot(at, beam.direction);
    const double radius = glm::length(at - along * beam.direction);
    EXPECT_NEAR(radius, 0.04 + along * std::tan(0.25), 1e-5);
    EXPECT_NEAR(v.light[0], 1, 1e-6);
    EXPECT_NEAR(v.light[1], 0.2140, 1e-4) << "sRGB 0.5 as linear light";
    if (along < 1e-5) brightness_near = v.corner[3];
    EXPECT_LE(v.corner[3], brightness_near + 1e-6);
    const Vec3 normal(v.normal[0], v.normal[1], v.normal[2]);
    EXPECT_NEAR(glm::length(normal), 1, 1e-5);
    EXPECT_LT(glm::dot(normal, beam.direction), 0) << "a widening cone";
  }
}

TEST(Beams, ADarkBeamIsNotDrawn) {
  std::vector<BeamVertex> triangles;
  add_beam({{0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.5}, triangles);
  add_beam({{NAN, 0, 0}, {0, 0, 1}, {1, 1, 1}, 0.5}, triangles);
  EXPECT_TRUE(triangles.empty());
}

}  // namespace
}  // namespace limber::render
