// <hfield> of MJCF files.
#include <string>

#include <gtest/gtest.h>

#include "files.h"
#include "import_text.h"
#include "mjcf_text.h"
#include "model/mesh/surface.h"

namespace limber::model {
namespace {

using test::all_problems;
using test::expect_near;
using test::has_problem;
using test::mjcf;

TEST(MjcfTerrain, ReadsHeightfields) {
  const BodyModel m = mjcf(R"(<mujoco><asset>
<hfield name="hill" nrow="2" ncol="3" size="3 1 0.5 0.1" elevation="1 2 3  4 5 9"/>
<hfield name="flat" nrow="4" ncol="4" size="1 1 1 1"/></asset>
<worldbody><geom type="hfield" hfield="hill" pos="0 0 1"/><geom type="hfield" hfield="flat"/></worldbody></mujoco>)");
  ASSERT_EQ(m.links.size(), 1u);
  ASSERT_EQ(m.links[0].collisions.size(), 2u) << all_problems(m);
  const PlacedShape& hill = m.links[0].collisions[0];
  ASSERT_NE(hill.shape.surface, nullptr);
  expect_near(hill.origin.position, {0, 0, 1}, 1e-12);
  // the first line of numbers is at +y; they are stretched to 0 .. 0.5 m
  const std::vector<Vec3>& vertices = hill.shape.mesh->vertices;
  ASSERT_EQ(vertices.size(), 6u);
  expect_near(vertices[0], {-3, -1, 3.0 / 16}, 1e-12);
  expect_near(vertices[2], {3, -1, 0.5}, 1e-12);
  expect_near(vertices[3], {-3, 1, 0}, 1e-12);
  EXPECT_EQ(m.links[0].inertial.mass, 0);
  EXPECT_EQ(m.links[0].collisions[1].shape.surface->size(), 18u);
}

TEST(MjcfTerrain, ReportsHeightfieldsThatItCannotUse) {
  const BodyModel m = mjcf(R"(<mujoco><asset>
<hfield name="huge" nrow="2000" ncol="3" size="3 1 0.5 0.1"/>
<hfield name="few" nrow="2" ncol="2" size="1 1 1 1" elevation="1 2 3"/>
<hfield name="lost" file="lost.png" size="1 1 1 1"/></asset>
<worldbody><geom type="hfield" hfield="huge"/><geom type="hfield" hfield="lost"/><geom type="hfield"/>
<body><freejoint/><geom size=".1"/><geom type="hfield" hfield="few"/></body></worldbody></mujoco>)");
  EXPECT_TRUE(has_problem(m, Severity::error, "<hfield name='huge'> ignored: nrow and ncol are 2 .. 1024", 2))
      << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "elevation", 3)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "hfield 'huge' does not exist", 5)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "heightfield ignored: 'lost.png' not found", 5)) << all_problems(m);
  EXPECT_TRUE(has_problem(m, Severity::error, "names no hfield", 5)) << all_problems(m);
}

}  // namespace
}  // namespace limber::model
