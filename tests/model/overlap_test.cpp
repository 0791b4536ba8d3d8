// Penetration depths of shapes with known results, and overlapping links of models.
#include "model/overlap.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "import_text.h"

namespace limber::model {
namespace {

PlacedShape placed_at(ShapeModel shape, const Vec3& position, const Quat& rotation = quat_identity()) {
  PlacedShape out;
  out.shape = std::move(shape);
  out.origin = {position, rotation};
  return out;
}

ShapeModel box_of(const Vec3& size) {
  ShapeModel m;
  m.kind = ShapeKind::box;
  m.size = size;
  return m;
}

ShapeModel round_of(ShapeKind kind, double radius, double height = 0) {
  ShapeModel m;
  m.kind = kind;
  m.radius = radius;
  m.height = height;
  return m;
}

ShapeModel hull_of(const std::vector<Vec3>& points) {
  auto mesh = std::make_shared<MeshModel>();
  mesh->hull = points;
  ShapeModel m;
  m.kind = ShapeKind::mesh;
  m.mesh = mesh;
  return m;
}

ShapeModel wedge() { return hull_of({{0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}}); }

/// Two touching shapes: moving `b` by `gap` along z separates them, or makes them overlap by -gap.
struct Touching {
  std::string name;
  ShapeModel a, b;
  Vec3 at;
};

const std::vector<Touching>& touching() {
  static const std::vector<Touching> all{
      {"boxes", box_of({0.2, 0.2, 0.2}), box_of({0.3, 0.1, 0.1}), {0.05, 0.02, 0.15}},
      {"spheres", round_of(ShapeKind::sphere, 0.1), round_of(ShapeKind::sphere, 0.05), {0, 0, 0.15}},
      {"box_sphere", box_of({0.2, 0.2, 0.2}), round_of(ShapeKind::sphere, 0.05), {0.03, 0, 0.15}},
      {"capsules", round_of(ShapeKind::capsule, 0.05, 0.1), round_of(ShapeKind::capsule, 0.02, 0.3), {0, 0, 0.27}},
      {"cylinders",
       round_of(ShapeKind::cylinder, 0.05, 0.1),
       round_of(ShapeKind::cylinder, 0.03, 0.2),
       {0.02, 0, 0.15}},
      {"cone_on_box", box_of({0.2, 0.2, 0.2}), round_of(ShapeKind::cone, 0.05, 0.1), {0.01, 0, 0.15}},
      {"hull_on_box", box_of({0.2, 0.2, 0.2}), wedge(), {0, 0, 0.1}},
      {"large_boxes", box_of({40, 40, 40}), box_of({60, 20, 20}), {1, 2, 30}},
  };
  return all;
}

// both rotated, so that nothing is axis-aligned and every coordinate has rounding errors
double depth_of(const Touching& t, double gap, bool turned) {
  const Pose frame = turned ? Pose{{3.1, -2.7, 1.3}, quat_euler(0.3, -1.1, 2.2)} : Pose{};
  PlacedShape a = placed_at(t.a, {0, 0, 0});
  PlacedShape b = placed_at(t.b, t.at + Vec3(0, 0, gap));
  a.origin = frame * a.origin;
  b.origin = frame * b.origin;
  return overlap_depth(a, b);
}

TEST(Overlap, TouchingShapesDoNotOverlap) {
  for (const Touching& t : touching()) {
    for (const bool turned : {false, true}) {
      EXPECT_EQ(depth_of(t, 0, turned), 0) << t.name << turned;
      EXPECT_EQ(depth_of(t, -0.00005, turned), 0) << t.name << turned;
      EXPECT_EQ(depth_of(t, 0.001, turned), 0) << t.name << turned;
    }
  }
}

TEST(Overlap, ReportsDepthsAboveATenthOfAMillimeter) {
  for (const Touching& t : touching()) {
    for (const bool turned : {false, true}) {
      for (const double depth : {0.0002, 0.0005, 0.003}) {
        EXPECT_NEAR(depth_of(t, -depth, turned), depth, 0.02 * depth) << t.name << turned;
        EXPECT_NEAR(depth_of({t.name, t.b, t.a, -t.at}, depth, turned), depth, 0.02 * depth) << t.name << turned;
      }
    }
  }
}

TEST(Overlap, MeasuresOverlapsOfEdgesAndCorners) {
  // a cube standing on an edge: its center is half a diagonal above the face
  const double high = 0.1 + 0.1 * std::sqrt(2.0);
  const PlacedShape floor = placed_at(box_of({1, 1, 0.2}), {0, 0, 0});
  const auto on_edge = [&](double z) {
    return placed_at(box_of({0.2, 0.2, 0.2}), {0, 0, z}, quat_euler(kPi / 4, 0, 0));
  };
  EXPECT_EQ(overlap_depth(floor, on_edge(high)), 0);
  EXPECT_NEAR(overlap_depth(floor, on_edge(high - 0.0005)), 0.0005, 1e-5);
  // crossed edges: the shortest separation is along the normal of both edges
  const PlacedShape below = placed_at(box_of({0.2, 0.2, 0.2}), {0, 0, 0}, quat_euler(0, kPi / 4, 0));
  EXPECT_EQ(overlap_depth(below, on_edge(0.2 * std::sqrt(2.0))), 0);
  EXPECT_NEAR(overlap_depth(below, on_edge(0.2 * std::sqrt(2.0) - 0.001)), 0.001, 2e-5);
}

TEST(Overlap, ConcentricShapesOverlap) {
  for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::capsule, ShapeKind::cone}) {
    const PlacedShape shape = placed_at(round_of(kind, 0.1, 0.2), {0, 0, 0});
    EXPECT_GT(overlap_depth(shape, shape), 0.05);
  }
  const PlacedShape box = placed_at(box_of({0.2, 0.2, 0.2}), {0, 0, 0});
  EXPECT_NEAR(overlap_depth(box, box), 0.2, 0.004);
}

TEST(Overlap, CrossingFlatShapesOverlap) {
  const PlacedShape plate = placed_at(box_of({1, 1, 0.002}), {0, 0, 0});
  const PlacedShape upright = placed_at(box_of({0.002, 1, 1}), {0, 0, 0});
  EXPECT_NEAR(overlap_depth(plate, upright), 0.501, 0.02);
  EXPECT_NEAR(overlap_depth(plate, placed_at(box_of({1, 1, 0.002}), {0, 0, 0.0015})), 0.0005, 1e-5);
}

TEST(Overlap, PlanesNeverOverlap) {
  ShapeModel plane;
  plane.kind = ShapeKind::plane;
  EXPECT_EQ(overlap_depth(placed_at(plane, {0, 0, 0}), placed_at(box_of({1, 1, 1}), {0, 0, 0})), 0);
}

TEST(Overlap, AgreesWithRandomSpheres) {
  // spheres in random directions from a box; the reference distance is computed by clamping
  unsigned state = 7;
  const auto next = [&](double limit) {
    state = state * 1664525u + 1013904223u;
    return limit * (2.0 * (state >> 8) / 16777216.0 - 1);
  };
  int overlapping = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 at(next(0.5), next(0.5), next(0.5));
    const Vec3 half(0.1, 0.2, 0.3);
    const Vec3 outside = glm::max(glm::abs(at) - half, Vec3(0));
    const double distance = glm::length(outside);
    if (distance == 0) continue;
    const double depth = 0.15 - distance;
    const double found =
        overlap_depth(placed_at(box_of(2.0 * half), {0, 0, 0}), placed_at(round_of(ShapeKind::sphere, 0.15), at));
    if (depth > 0.0001001) {
      EXPECT_NEAR(found, depth, 0.021 * depth + 2e-7) << i;
      overlapping++;
    } else if (depth < 0.0000999) {
      EXPECT_EQ(found, 0) << i;
    }
  }
  EXPECT_GT(overlapping, 50);
}

// links in a star around the base, so that no two of them share a joint
std::string star(const std::string& links, const std::string& more = "") {
  return "<robot name=\"star\"><link name=\"base\"/>\n" + links + more + "</robot>";
}
std::string arm_of(const std::string& name, const std::string& xyz, const std::string& joint = "revolute",
                   const std::string& lower = "-1") {
  return "<link name=\"" + name + "\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" " +
         "iyz=\"0\" izz=\"1\"/></inertial><collision><geometry><box size=\"0.2 0.2 "
         "0.2\"/></geometry></collision></link>" +
         "<joint name=\"to_" + name + "\" type=\"" + joint + "\"><origin xyz=\"" + xyz + "\"/><parent link=\"base\"/>" +
         "<child link=\"" + name + "\"/><axis xyz=\"1 0 0\"/><limit lower=\"" + lower +
         "\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>\n";
}

TEST(Overlap, ModelsListOverlappingPairs) {
  const BodyModel m = test::import_text(
      star(arm_of("a", "0 0 0") + arm_of("b", "0.1995 0 0") + arm_of("c", "0 0.2 0") + arm_of("d", "0.399 0 0.1")));
  ASSERT_EQ(m.overlaps.size(), 2u);
  EXPECT_EQ(m.links[static_cast<std::size_t>(m.overlaps[0].a)].name, "a");
  EXPECT_EQ(m.links[static_cast<std::size_t>(m.overlaps[0].b)].name, "b");
  EXPECT_NEAR(m.overlaps[0].depth, 0.0005, 1e-5);
  EXPECT_EQ(m.links[static_cast<std::size_t>(m.overlaps[1].b)].name, "d");
  EXPECT_TRUE(
      test::has_problem(m, Severity::warning,
                        "'a' and 'b' overlap at the home pose (0.5 mm); excluded from collision … and 1 more of this "
                        "kind",
                        2))
      << test::all_problems(m);
}

TEST(Overlap, UsesTheHomePose) {
  // the slide starts at 0.1, because its limits exclude 0; nothing overlaps there
  const std::string away = arm_of("b", "0.1 0 0", "prismatic", "0.5");
  EXPECT_EQ(test::import_text(star(arm_of("a", "0 0 0") + away)).overlaps.size(), 1u);
  // links that are separated at 0 but overlap at the start are not listed
  const std::string into = arm_of("b", "-0.6 0 0", "prismatic", "0.5");
  EXPECT_EQ(test::import_text(star(arm_of("a", "0 0 0") + into)).overlaps.size(), 0u);
}

TEST(Overlap, OmitsLinksConnectedByAJoint) {
  const BodyModel m = test::import_text(
      R"(<robot name="r"><link name="a"><collision><geometry><sphere radius="1"/></geometry></collision></link>
<link name="b"><collision><geometry><sphere radius="1"/></geometry></collision></link>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>)");
  EXPECT_TRUE(m.overlaps.empty());
}

TEST(Overlap, BoundsTheWorkForLargeModels) {
  // 400 boxes in a row, each overlapping its neighbor: 399 of 79 800 pairs
  std::vector<PlacedShape> shape{placed_at(box_of({0.2, 0.2, 0.2}), {0, 0, 0})};
  std::vector<OverlapPart> parts;
  for (int i = 0; i < 400; ++i) parts.push_back({shape, {{0.15 * i, 0, 0}, quat_identity()}});
  const OverlapResult found = find_overlaps(parts, [](std::size_t, std::size_t) { return true; });
  EXPECT_EQ(found.found.size(), 399u);
  EXPECT_EQ(found.unchecked, 0u);
  // many flat shapes that cross without touching exceed the work limit: the remaining pairs are counted, not checked
  std::vector<PlacedShape> comb;
  for (int i = 0; i < 1000; ++i) {
    comb.push_back(placed_at(box_of({1, 0.0001, 1}), {0, 0.001 * i, 0}, quat_euler(0, 0, 0.0004)));
  }
  std::vector<OverlapPart> combs;
  for (int i = 0; i < 8; ++i) combs.push_back({comb, {{0, 0.0004 + 1e-5 * i, 0}, quat_identity()}});
  const OverlapResult bounded = find_overlaps(combs, [](std::size_t, std::size_t) { return true; });
  EXPECT_GT(bounded.unchecked, 0u);
}

}  // namespace
}  // namespace limber::model
