// Rays and spheres: hits are those of the closed forms of each shape, and the tree finds what a search over all parts
// finds.
#include "sim/sensors/part_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "model/mesh/hull.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;
using model::ShapeKind;

constexpr double kTestRadius = 0.3;
constexpr double kTestHeight = 0.8;
const Vec3 kTestBox{0.4, 0.6, 1.0};

struct SurfacePoint {
  Vec3 position;
  Vec3 normal;
};

struct SurfaceSampler {
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }
  Vec3 direction() {
    const double z = uniform(-1, 1);
    const double angle = uniform(-kPi, kPi);
    const double rho = std::sqrt(1 - z * z);
    return {rho * std::cos(angle), rho * std::sin(angle), z};
  }
  Quat rotation() { return quat_axis(direction(), uniform(-kPi, kPi)); }
  Vec3 around() {  // a unit vector in the plane z = 0
    const double angle = uniform(-kPi, kPi);
    return {std::cos(angle), std::sin(angle), 0};
  }
  Vec3 in_disc(double radius) { return around() * radius * std::sqrt(uniform(0, 1)); }

  SurfacePoint on(ShapeKind kind) {
    switch (kind) {
      case ShapeKind::plane:
        return {{uniform(-3, 3), uniform(-3, 3), 0}, {0, 0, 1}};
      case ShapeKind::sphere: {
        const Vec3 n = direction();
        return {kTestRadius * n, n};
      }
      case ShapeKind::box: {
        Vec3 p = kTestBox * Vec3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5));
        Vec3 n(0);
        const int axis = static_cast<int>(uniform(0, 3));
        n[axis] = uniform(0, 1) < 0.5 ? -1 : 1;
        p[axis] = n[axis] * kTestBox[axis] / 2;
        return {p, n};
      }
      case ShapeKind::ellipsoid: {
        const Vec3 p = direction() * kTestBox / 2.0;
        return {p, glm::normalize(p / (kTestBox * kTestBox))};
      }
      case ShapeKind::cylinder: {
        const Vec3 n = around();
        if (uniform(0, 1) < 0.5) return {kTestRadius * n + Vec3(0, 0, uniform(-0.5, 0.5) * kTestHeight), n};
        const double side = uniform(0, 1) < 0.5 ? -1 : 1;
        return {in_disc(kTestRadius) + Vec3(0, 0, side * kTestHeight / 2), {0, 0, side}};
      }
      case ShapeKind::capsule: {
        const Vec3 n = direction();
        const Vec3 flat = around();
        if (uniform(0, 1) < 0.5) return {kTestRadius * flat + Vec3(0, 0, uniform(-0.5, 0.5) * kTestHeight), flat};
        return {kTestRadius * n + Vec3(0, 0, std::copysign(kTestHeight / 2, n.z)), n};
      }
      case ShapeKind::cone: {
        if (uniform(0, 1) < 0.3) return {in_disc(kTestRadius) + Vec3(0, 0, -kTestHeight / 2), {0, 0, -1}};
        const Vec3 n = around();
        const double t = uniform(0.01, 1);  // 0: apex
        return {n * kTestRadius * t + Vec3(0, 0, kTestHeight * (0.5 - t)),
                glm::normalize(n * kTestHeight + Vec3(0, 0, kTestRadius))};
      }
      default: {  // a tetrahedron with the corners kCorners
        const int face = static_cast<int>(uniform(0, 4));
        const Vec3 a = kCorners[static_cast<std::size_t>((face + 1) % 4)];
        const Vec3 b = kCorners[static_cast<std::size_t>((face + 2) % 4)];
        const Vec3 c = kCorners[static_cast<std::size_t>((face + 3) % 4)];
        Vec3 n = glm::normalize(glm::cross(b - a, c - a));
        if (glm::dot(n, kCorners[static_cast<std::size_t>(face)] - a) > 0) n = -n;
        double u = uniform(0, 1);
        double v = uniform(0, 1);
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        return {a + u * (b - a) + v * (c - a), n};
      }
    }
  }

  static constexpr std::array<Vec3, 4> kCorners{Vec3(0.5, 0, -0.2), Vec3(-0.3, 0.4, -0.2), Vec3(-0.3, -0.5, -0.2),
                                                Vec3(0.1, 0.05, 0.6)};
  std::mt19937 generator{7};
};

model::ShapeModel test_shape(ShapeKind kind) {
  if (kind == ShapeKind::plane) return plane_model();
  if (kind == ShapeKind::sphere) return sphere_model(kTestRadius);
  if (kind == ShapeKind::box) return box_model(kTestBox);
  if (kind == ShapeKind::ellipsoid) {
    model::ShapeModel shape = box_model(kTestBox);
    shape.kind = kind;
    return shape;
  }
  if (kind != ShapeKind::mesh) return round_model(kind, kTestRadius, kTestHeight);
  model::ShapeModel shape;
  shape.kind = kind;
  auto mesh = std::make_shared<model::MeshModel>();
  const model::Hull hull = model::convex_hull(SurfaceSampler::kCorners);
  mesh->vertices = mesh->hull = hull.vertices;
  mesh->triangles = hull.triangles;
  mesh->unit_inertial.mass = 1;
  mesh->unit_inertial.tensor = Mat3(0.1);
  shape.mesh = mesh;
  return shape;
}

constexpr std::array kTestKinds{ShapeKind::plane,   ShapeKind::sphere, ShapeKind::box,       ShapeKind::cylinder,
                                ShapeKind::capsule, ShapeKind::cone,   ShapeKind::ellipsoid, ShapeKind::mesh};

// A convex solid lies behind the tangent plane of each point of its surface: a ray from the outer side of this plane to
// the point hits the solid exactly there.
TEST(PartTree, RaysHitTheSurfaceOfEachShape) {
  SurfaceSampler sampler;
  for (const ShapeKind kind : kTestKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    WorldFixture s;
    const Pose pose{3.0 * sampler.direction(), sampler.rotation()};
    const Part& part = s.add_single_part(test_shape(kind), 0, pose);
    for (int i = 0; i < 300; i++) {
      const SurfacePoint point = sampler.on(kind);
      Vec3 outward = sampler.direction();
      if (glm::dot(outward, point.normal) < 0) outward = -outward;
      if (glm::dot(outward, point.normal) < 0.02) continue;
      const double length = sampler.uniform(0.01, 20);
      const Vec3 target = pose * point.position;
      const Vec3 from = target + length * (pose.rotation * outward);
      const Vec3 direction = -(pose.rotation * outward);
      const std::optional<RayHit> hit = s.world.sensing().parts().ray(from, direction, length + 1);
      ASSERT_TRUE(hit) << i;
      EXPECT_EQ(hit->part, &part);
      EXPECT_NEAR(hit->distance, length, 1e-7);
      EXPECT_LT(glm::length(hit->position - target), 1e-7);
      EXPECT_LT(glm::length(hit->normal - pose.rotation * point.normal), 1e-5);
      EXPECT_FALSE(s.world.sensing().parts().ray(from, direction, length - 1e-6)) << "too short";
      EXPECT_FALSE(s.world.sensing().parts().ray(from, -direction, 100)) << "leads away";
      EXPECT_FALSE(s.world.sensing().parts().ray(target + 1e-4 * direction, direction, 100)) << "starts inside";
    }
  }
}

TEST(PartTree, DistancesAreThoseOfEachShape) {
  SurfaceSampler sampler;
  for (const ShapeKind kind : kTestKinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    WorldFixture s;
    const Pose pose{sampler.direction(), sampler.rotation()};
    s.add_single_part(test_shape(kind), 0, pose);
    std::vector<NearPart> found;
    for (int i = 0; i < 200; i++) {
      // the point of a convex surface is the nearest one to all points along its normal
      const SurfacePoint point = sampler.on(kind);
      const double distance = sampler.uniform(0.001, 2);
      const Vec3 center = pose * (point.position + distance * point.normal);
      s.world.sensing().parts().find_near(center, distance + 1e-6, {}, found);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_NEAR(found[0].distance, distance, 1e-7);
      s.world.sensing().parts().find_near(center, distance - 1e-6, {}, found);
      EXPECT_TRUE(found.empty());
      s.world.sensing().parts().find_near(pose * (0.999 * point.position - 1e-9 * point.normal), 0, {}, found);
      EXPECT_EQ(found.size(), 1u) << "inside";
    }
  }
}

struct HundredParts : WorldFixture {
  HundredParts() {
    for (int i = 0; i < 100; i++) {
      const ShapeKind kind = kTestKinds[static_cast<std::size_t>(1 + i % 6)];
      parts.push_back(&add_single_part(test_shape(kind), 1, random_pose()));
    }
  }
  Pose random_pose() { return {5.0 * sampler.uniform(0, 1) * sampler.direction(), sampler.rotation()}; }
  // Nearest hit of a search over all parts.
  std::optional<RayHit> search(const Vec3& from, const Vec3& direction, double max) const {
    std::optional<RayHit> nearest;
    for (const Part* part : parts) {
      const Solid solid(part->geometry()->placed[0]);
      const Pose pose = part->pose() * solid.origin();
      const Quat inverse = glm::conjugate(pose.rotation);
      const auto hit = solid.intersect(inverse * (from - pose.position), inverse * direction, max);
      if (hit && (!nearest || hit->distance < nearest->distance)) nearest = RayHit{part, {}, {}, hit->distance};
    }
    return nearest;
  }
  void compare() {
    int hits = 0;
    for (int i = 0; i < 300; i++) {
      const Vec3 from = 8.0 * sampler.direction();
      const Vec3 direction = glm::normalize(3.0 * sampler.direction() - from);
      const auto expected = search(from, direction, 20);
      const auto hit = world.sensing().parts().ray(from, direction, 20);
      ASSERT_EQ(hit.has_value(), expected.has_value());
      if (!hit) continue;
      hits++;
      EXPECT_EQ(hit->part, expected->part);
      EXPECT_NEAR(hit->distance, expected->distance, 1e-12);
    }
    EXPECT_GT(hits, 100);
  }
  SurfaceSampler sampler;
  std::vector<Part*> parts;
};

TEST(PartTree, FindsWhatASearchOverAllPartsFinds) {
  HundredParts s;
  s.compare();
  for (int i = 0; i < 40; i++) s.ticks(1), s.world.sensing().parts().ray({0, 0, 0}, {1, 0, 0}, 1);
  s.compare();
}

TEST(PartTree, FollowsPosesRemovedAndDisabledBodies) {
  HundredParts s;
  for (Part* part : s.parts) part->set_pose(s.random_pose());
  s.compare();
  for (Part* part : s.parts) {
    const Pose pose = s.random_pose();
    s.set(part->id(), "position", {pose.position.x, pose.position.y, pose.position.z});
  }
  s.compare();
  s.set(s.parts[3]->body().id(), "enabled", {0});
  s.world.flush();
  s.parts.erase(s.parts.begin() + 3);
  s.compare();
  s.world.remove_body(s.parts[50]->body());
  s.parts.erase(s.parts.begin() + 50);
  s.compare();
}

TEST(PartTree, IgnoresABodyOrAPart) {
  WorldFixture s;
  Body& body = s.body("body");
  const Part& near = s.part(body, sphere_model(0.1), 1, {{1, 0, 0}, quat_identity()});
  const Part& far = s.part(body, sphere_model(0.1), 1, {{2, 0, 0}, quat_identity()});
  const Part& behind = s.add_single_part(sphere_model(0.1), 1, {{3, 0, 0}, quat_identity()});
  PartTree& tree = s.world.sensing().parts();
  EXPECT_EQ(tree.ray({0, 0, 0}, {1, 0, 0}, 10)->part, &near);
  EXPECT_EQ(tree.ray({0, 0, 0}, {1, 0, 0}, 10, {nullptr, &near})->part, &far);
  EXPECT_EQ(tree.ray({0, 0, 0}, {1, 0, 0}, 10, {&body, nullptr})->part, &behind);
  std::vector<NearPart> found;
  tree.find_near({2, 0, 0}, 1, {&body, nullptr}, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].part, &behind);
}

}  // namespace
}  // namespace limber::sim
