// Loops of joints that a model file declares: closed forms of linkages, energy, copies and rebuilt bodies.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "model/urdf/import.h"
#include "random_models.h"
#include "sim/state/body_state.h"
#include "stage.h"

namespace limber::sim {
namespace {

constexpr double kCrank = 0.1, kRod = 0.3, kRocker = 0.25, kGround = 0.3;

std::string bar_text(const std::string& name, double length, double mass) {
  return fmt::format(
      R"(<link name="{}"><inertial><origin xyz="{} 0 0"/><mass value="{}"/><inertia ixx="1e-4" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="0"/></inertial></link>)",
      name, length / 2, mass, std::max(mass * length * length / 12, 1e-4), std::max(mass * length * length / 12, 1e-4));
}
std::string hinge_text(const std::string& name, const std::string& parent, const std::string& child, double x) {
  return fmt::format(
      R"(<joint name="{}" type="continuous"><origin xyz="{} 0 0"/><parent link="{}"/><child link="{}"/><axis xyz="0 0 1"/><limit effort="1000" velocity="0"/></joint>)",
      name, x, parent, child);
}
std::string closing_text(const std::string& type, const std::string& child, double x) {
  return fmt::format(
      R"(<limber:loop name="c" type="{}"><parent link="rod"><origin xyz="{} 0 0"/></parent><child link="{}"><origin xyz="{} 0 0"/></child><axis xyz="0 0 1"/></limber:loop>)",
      type, kRod, child, x);
}

std::string four_bar(const std::string& type = "revolute") {
  return R"(<robot name="four_bar" xmlns:limber="https://limber/urdf"><link name="base"/>)" +
         bar_text("crank", kCrank, 0.1) + bar_text("rod", kRod, 0.3) + bar_text("rocker", kRocker, 0.25) +
         hinge_text("a", "base", "crank", 0) + hinge_text("b", "crank", "rod", kCrank) +
         hinge_text("d", "base", "rocker", kGround) + closing_text(type, "rocker", kRocker) + "</robot>";
}

std::string slider_crank() {
  return R"(<robot name="slider_crank" xmlns:limber="https://limber/urdf"><link name="base"/>)" +
         bar_text("crank", kCrank, 0.1) + bar_text("rod", kRod, 0.3) + bar_text("piston", 0, 0.25) +
         hinge_text("a", "base", "crank", 0) + hinge_text("b", "crank", "rod", kCrank) +
         R"(<joint name="d" type="prismatic"><origin xyz="0.4 0 0"/><parent link="base"/><child link="piston"/><axis xyz="1 0 0"/><limit effort="1" velocity="0"/></joint>)" +
         closing_text("revolute", "piston", 0) + "</robot>";
}

/// Point C of the four-bar linkage, where rod and rocker meet, for an angle of the crank.
Vec3 meeting_point(double angle) {
  const Vec3 b = kCrank * Vec3(std::cos(angle), std::sin(angle), 0);
  const Vec3 way = Vec3(kGround, 0, 0) - b;
  const double distance = glm::length(way);
  const double along = (kRod * kRod - kRocker * kRocker + distance * distance) / (2 * distance);
  const double across = std::sqrt(kRod * kRod - along * along);
  return b + (along * way + across * Vec3(-way.y, way.x, 0)) / distance;
}

model::ImportOptions closed_pose() {
  const Vec3 c = meeting_point(0);
  model::ImportOptions options;
  options.pose = {{"b", std::atan2(c.y, c.x - kCrank)}, {"d", std::atan2(c.y, c.x - kGround)}};
  return options;
}

struct Linkage : test::WorldFixture {
  explicit Linkage(const std::string& text, const model::ImportOptions& options = {}) {
    model::MeshLibrary meshes;
    const auto model = model::import_urdf_text(text, "linkage.urdf", options, meshes);
    if (!model) ADD_FAILURE() << model.error();
    BuildOptions build;
    build.servo_motors = false;
    body = *world.add_body(*model, "linkage", build);
  }

  void spin(double speed) {
    set(body->find_motor("a")->id(), "mode", {1});
    set(body->find_motor("a")->id(), "speed", {speed});
  }
  Vec3 at(const std::string& part, double x) const { return body->find_part(part)->pose() * Vec3(x, 0, 0); }
  double angle() const { return body->find_joint("a")->value(); }

  Body* body;
};

TEST(Loop, FourBarFollowsItsClosedFormAt60RadPerSecond) {
  Linkage s(four_bar(), closed_pose());
  s.spin(60);
  double error = 0, gap = 0;
  for (int tick = 0; tick < 600; tick++) {
    s.world.step();
    const Vec3 c = meeting_point(s.angle());
    if (tick >= 10)
      error = std::max({error, glm::length(s.at("rod", kRod) - c), glm::length(s.at("rocker", kRocker) - c)});
    gap = std::max(gap, test::widest_gap(*s.body));
  }
  EXPECT_NEAR(s.number(s.body->find_joint("a")->id(), "speed"), 60, 1e-3);
  EXPECT_LT(error, 1e-4);
  EXPECT_LT(gap, 1e-4);
}

TEST(Loop, SliderCrankFollowsItsClosedFormAt60RadPerSecond) {
  Linkage s(slider_crank());
  s.spin(60);
  double error = 0, gap = 0;
  for (int tick = 0; tick < 600; tick++) {
    s.world.step();
    const double side = kCrank * std::sin(s.angle());
    const Vec3 piston(kCrank * std::cos(s.angle()) + std::sqrt(kRod * kRod - side * side), 0, 0);
    error = std::max({error, glm::length(s.at("piston", 0) - piston), glm::length(s.at("rod", kRod) - piston)});
    gap = std::max(gap, test::widest_gap(*s.body));
  }
  EXPECT_NEAR(s.number(s.body->find_joint("a")->id(), "speed"), 60, 1e-3);
  EXPECT_LT(error, 1e-4);
  EXPECT_LT(gap, 1e-4);
}

TEST(Loop, PassiveLinkageGainsNoEnergy) {
  for (const char* const type : {"revolute", "spherical"}) {
    Linkage s(four_bar(type), closed_pose());
    s.gravity({0, -9.81, 0});
    // velocities belong to the middle between two steps
    const auto energy = [&] {
      double sum = 0;
      for (const auto& part : s.body->parts()) {
        if (part->is_static()) continue;
        const double mass = s.number(part->id(), "mass");
        const double height = part->center().y - part->linear_velocity().y * s.h() / 2;
        sum += test::kinetic_energy(part->rigid()) + mass * 9.81 * height;
      }
      return sum;
    };
    const double start = energy();
    double highest = start, gap = 0;
    for (int tick = 0; tick < 1200; tick++) {
      s.world.step();
      highest = std::max(highest, energy());
      gap = std::max(gap, test::widest_gap(*s.body));
    }
    EXPECT_LT(highest - start, 1e-4 * std::abs(start)) << type;
    EXPECT_LT(gap, 1.5e-4) << type;
    EXPECT_GT(std::abs(s.angle()), 1e-3) << type;
  }
}

TEST(Loop, OpenLoopIsPulledClosed) {
  model::ImportOptions options = closed_pose();
  options.pose["d"] += 0.05;
  Linkage s(four_bar(), options);
  EXPECT_GT(test::widest_gap(*s.body), 0.01);
  s.ticks(120);
  EXPECT_LT(test::widest_gap(*s.body), 1e-4);
}

TEST(Loop, ACopyMovesLikeTheOriginal) {
  Linkage s(four_bar(), closed_pose());
  s.spin(20);
  s.ticks(30);
  Body& copy = **s.world.copy_body(*s.body, "copy");
  EXPECT_EQ(copy.joints().size(), s.body->joints().size());
  const Vec3 aside(0, 0, 2);
  copy.set_pose({aside, quat_identity()});
  s.ticks(60);
  for (const auto& part : s.body->parts()) {
    const Vec3 there = copy.find_part(part->name())->pose().position;
    EXPECT_LT(glm::length(there - aside - part->pose().position), 1e-4) << part->name();
  }
  EXPECT_LT(test::widest_gap(copy), 1e-4);
}

TEST(Loop, ARebuiltBodyKeepsItsPose) {
  Linkage s(four_bar(), closed_pose());
  s.spin(20);
  s.ticks(30);
  const Vec3 before = s.at("rocker", kRocker);
  Linkage blueprint(four_bar(), closed_pose());
  Body& rebuilt = rebuild_body(s.world, *s.body, *blueprint.body, {});
  s.body = &rebuilt;
  EXPECT_LT(glm::length(s.at("rocker", kRocker) - before), 1e-6);
  s.ticks(30);
  EXPECT_LT(test::widest_gap(rebuilt), 1e-4);
}

}  // namespace
}  // namespace limber::sim
