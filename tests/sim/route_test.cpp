// Routes: ranges, curves, smoothing, lag, combination, patterns, components, waiting, cycles, bad input, checkpoints.
#include "sim/routes/route_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/behavior/behavior_list.h"
#include "sim/stage.h"
#include "sim/state/world_checkpoint.h"

namespace limber::sim {
namespace {

using namespace test;

constexpr double kRouteTick = 1.0 / 60;

// Free balls a and b without gravity. The mass of b is a target, and the friction of a is a source, because nothing but
// a test changes them.
struct RouteFixture : WorldFixture {
  RouteFixture() : robot(body("robot")) {
    for (const char* name : {"a", "b", "c"}) {
      Part& added = *robot.add_part(name, shape(sphere_model(0.1)), 1, {{place++, 0, 0}, quat_identity()}).value();
      parts.push_back(&added);
    }
  }
  static std::string at(const std::string& rest) { return "/physics/body/robot/part/" + rest; }
  RouteList& routes() { return world.behaviors().routes(); }
  Route& route(const std::string& from, const std::string& to) {
    const std::string name = "route" + std::to_string(routes().list().size());
    return *routes().add(name, at(from), at(to)).value();
  }
  void input(double value) { set(parts[0]->id(), "friction", {value}); }
  double damping(std::size_t part = 1) const { return number(parts[part]->id(), "linear_damping"); }
  std::string problem(const std::string& from, const std::string& to) {
    Route& added = route(from, to);
    ticks(1);
    return added.problem();
  }

  Body& robot;
  std::vector<Part*> parts;
  double place = 0;
};

TEST(Routes, CopiesAValueInEachTick) {
  RouteFixture r;
  Route& route = r.route("a/friction", "b/linear_damping");
  for (const double value : {0.25, 0.5, 0.75}) {
    r.input(value);
    r.ticks(1);
    EXPECT_EQ(r.damping(), value);
    EXPECT_EQ(r.number(route.id(), "input"), value);
    EXPECT_EQ(r.number(route.id(), "output"), value);
  }
  EXPECT_EQ(r.number(route.id(), "links"), 1);
  EXPECT_EQ(route.problem(), "");
}

TEST(Routes, MapsARangeToARange) {
  RouteFixture r;
  Route& route = r.route("a/friction", "b/linear_damping");
  const double low = 0.2;
  const double high = 0.6;
  const auto output = [&](double value) {
    r.input(value);
    r.ticks(1);
    return r.number(route.id(), "output");
  };
  r.set(route.id(), "input_low", {low});
  r.set(route.id(), "input_high", {high});
  r.set(route.id(), "output_low", {10});
  r.set(route.id(), "output_high", {-30});
  for (const double value : {0.2, 0.3, 0.4, 0.6, 0.8})
    EXPECT_NEAR(output(value), 10 - 40 * (value - low) / (high - low), 1e-12) << value;
  r.set(route.id(), "clamp", {1});
  EXPECT_EQ(output(0.1), 10);
  EXPECT_EQ(output(0.9), -30);
  // an empty range is a threshold
  r.set(route.id(), "input_high", {low});
  EXPECT_EQ(output(0.19), 10);
  EXPECT_EQ(output(0.2), -30);
}

TEST(Routes, CurvesGoThroughBothEnds) {
  RouteFixture r;
  Route& route = r.route("a/friction", "b/linear_damping");
  const double t = 0.25;
  r.input(t);
  for (const auto& [curve, expected] :
       {std::pair(0, t), {1, 3 * t * t - 2 * t * t * t}, {2, t * t}, {3, 2 * t - t * t}}) {
    r.set(route.id(), "curve", {static_cast<double>(curve)});
    r.ticks(1);
    EXPECT_NEAR(r.damping(), expected, 1e-15) << curve;
  }
}

// A low pass of first order: after n ticks the rest of a step from 0 to 1 is e^(−n·dt/T).
TEST(Routes, SmoothingFollowsExponentially) {
  RouteFixture r;
  Route& route = r.route("a/friction", "b/linear_damping");
  r.set(route.id(), "smoothing", {0.2});
  r.input(0);
  r.ticks(1);
  r.input(1);
  for (int n = 1; n <= 30; n++) {
    r.ticks(1);
    EXPECT_NEAR(r.damping(), 1 - std::exp(-n * kRouteTick / 0.2), 1e-12) << n;
  }
}

TEST(Routes, LagDelaysByWholeTicks) {
  RouteFixture r;
  Route& route = r.route("a/friction", "b/linear_damping");
  r.set(route.id(), "lag", {0.1});  // 6 ticks
  for (int n = 0; n < 20; n++) {
    r.input(0.01 * (n + 1));
    r.ticks(1);
    EXPECT_EQ(r.damping(), 0.01 * (std::max(n - 6, 0) + 1)) << n;
  }
}

TEST(Routes, JoinsTheOutputsOfSeveralRoutes) {
  RouteFixture r;
  r.set(r.parts[0]->id(), "friction", {0.3});
  r.set(r.parts[2]->id(), "friction", {0.2});
  r.route("a/friction", "b/linear_damping");
  Route& second = r.route("c/friction", "b/linear_damping");
  for (const auto& [combine, expected] : {std::pair(0, 0.3 + 0.2), {1, 0.3}, {2, 0.2}}) {
    r.set(second.id(), "combine", {static_cast<double>(combine)});
    r.ticks(1);
    EXPECT_EQ(r.damping(), expected) << combine;
  }
}

TEST(Routes, ADisabledRouteLeavesItsTarget) {
  RouteFixture r;
  Route& route = r.route("a/friction", "b/linear_damping");
  r.input(0.5);
  r.ticks(1);
  r.set(route.id(), "enabled", {0});
  r.input(0.7);
  r.ticks(1);
  EXPECT_EQ(r.damping(), 0.5);
  r.set(r.parts[1]->id(), "linear_damping", {0.1});
  r.ticks(1);
  EXPECT_EQ(r.damping(), 0.1);
}

TEST(Routes, ReadsAndSetsComponents) {
  RouteFixture r;
  r.parts[0]->set_velocity({0.3, 0, 0.4}, {0, 0, 0});
  r.ticks(1);
  r.route("a/linear_velocity.length", "b/linear_damping");
  r.route("a/linear_velocity.z", "c/surface_velocity.y");
  r.set(r.parts[2]->id(), "surface_velocity", {1, 2, 3});
  r.ticks(1);
  EXPECT_NEAR(r.damping(), 0.5, 1e-6);
  const Vec3 conveyor = r.vec(r.parts[2]->id(), "surface_velocity");
  EXPECT_EQ(conveyor.x, 1);
  EXPECT_NEAR(conveyor.y, 0.4, 1e-6);
  EXPECT_EQ(conveyor.z, 3);
}

TEST(Routes, PatternsConnectOneToManyAndPairs) {
  RouteFixture r;
  r.input(0.5);
  r.route("a/friction", "{b,c}/linear_damping");
  r.ticks(1);
  EXPECT_EQ(r.damping(1), 0.5);
  EXPECT_EQ(r.damping(2), 0.5);
  r.set(r.parts[1]->id(), "friction", {0.125});
  Route& pairs = r.route("*/friction", "*/angular_damping");
  r.ticks(1);
  EXPECT_EQ(r.number(pairs.id(), "links"), 3);
  for (const Part* part : r.parts)
    EXPECT_EQ(r.number(part->id(), "angular_damping"), r.number(part->id(), "friction")) << part->name();
  EXPECT_EQ(r.problem("{a,b}/friction", "*/linear_damping"),
            "from matches 2 properties and to 3: a route connects one to many, many to one, or as many to as many");
}

// All sources are read before the first target is set: in a cycle, values move on by one route per tick.
TEST(Routes, ACycleLagsByOneTick) {
  RouteFixture r;
  r.route("a/friction", "b/friction");
  r.route("b/friction", "c/friction");
  r.route("c/friction", "a/friction");
  for (std::size_t i = 0; i < 3; i++) r.set(r.parts[i]->id(), "friction", {0.1 * static_cast<double>(i + 1)});
  r.ticks(1);
  EXPECT_EQ(r.number(r.parts[0]->id(), "friction"), 0.1 * 3);
  EXPECT_EQ(r.number(r.parts[1]->id(), "friction"), 0.1);
  EXPECT_EQ(r.number(r.parts[2]->id(), "friction"), 0.2);
}

TEST(Routes, AWaitingRouteStartsWhenItsTargetExists) {
  RouteFixture r;
  Route& route = r.route("a/friction", "d/linear_damping");
  r.ticks(2);
  EXPECT_NE(route.problem().find("to /physics/body/robot/part/d/linear_damping: there is no 'd'"), std::string::npos)
      << route.problem();
  EXPECT_EQ(r.number(route.id(), "links"), 0);
  Part& added = *r.robot.add_part("d", r.shape(sphere_model(0.1)), 1, {{5, 0, 0}, quat_identity()}).value();
  r.input(0.5);
  r.ticks(1);
  EXPECT_EQ(r.number(added.id(), "linear_damping"), 0.5);
  EXPECT_EQ(route.problem(), "");
  r.world.remove_body(r.robot);
  r.ticks(1);
  EXPECT_NE(route.problem().find("there is no 'robot' in /physics/body"), std::string::npos) << route.problem();
}

TEST(Routes, ReportsTheProblemOfItsPresentAddresses) {
  RouteFixture r;
  Route& route = r.route("x/friction", "b/linear_damping");
  r.ticks(1);
  EXPECT_NE(route.problem().find("there is no 'x'"), std::string::npos) << route.problem();
  ASSERT_TRUE(r.routes().connect(route, r.at("a/friction"), r.at("y/linear_damping")).ok());
  r.ticks(1);
  EXPECT_NE(route.problem().find("there is no 'y'"), std::string::npos) << route.problem();
}

TEST(Routes, ReportsUnsuitableEnds) {
  RouteFixture r;
  const auto ends_with = [](const std::string& text, const std::string& end) {
    return text.ends_with(end) ? "" : text;
  };
  EXPECT_EQ(
      ends_with(r.problem("a/position", "b/linear_damping"),
                "position has 3 numbers, linear_damping has 1 number: give a component of position, such as .x or "
                ".length"),
      "");
  EXPECT_EQ(ends_with(r.problem("a/friction", "b/linear_velocity"),
                      "friction has 1 number, linear_velocity has 3 numbers: give a component of linear_velocity, such "
                      "as .x"),
            "");
  EXPECT_EQ(ends_with(r.problem("a/friction.x", "b/friction"), "friction is a single number, without components"), "");
  EXPECT_EQ(
      ends_with(r.problem("a/position.w", "b/friction"), "position has no component 'w', only x, y and z, and length"),
      "");
  EXPECT_EQ(ends_with(r.problem("a/friction", "b/contact_normal_force"), "contact_normal_force is read-only"), "");
  EXPECT_EQ(ends_with(r.problem("a", "b/friction"), "this is an object, not a property"), "");
  EXPECT_EQ(ends_with(r.problem("a/apply_force", "b/friction"), "apply_force is an action, without a value"), "");
  EXPECT_EQ(ends_with(r.problem("x*/friction", "b/friction"), "the pattern matches nothing"), "");
  EXPECT_NE(r.problem("a/frictoin", "b/friction").find("friction"), std::string::npos);
}

TEST(Routes, RejectsBadNamesAndAddresses) {
  RouteFixture r;
  ASSERT_TRUE(r.routes().add("one", "/a", "/b").ok());
  EXPECT_EQ(r.routes().add("one", "/a", "/b").error(), "there is a route 'one' already; names are unique");
  EXPECT_EQ(r.routes().add("two", "a", "/b").error(), "route 'two': from: 'a' is not an address: it must begin with /");
  EXPECT_EQ(r.routes().add("two", "/a", std::string(600, '/')).error(),
            "route 'two': to: an address has at most 512 bytes");
  EXPECT_FALSE(r.routes().add("", "/a", "/b").ok());
  EXPECT_EQ(r.routes().list().size(), 1u);
}

// The same ticks again after a restored checkpoint: smoothing and lag continue bit for bit.
TEST(Routes, CheckpointsRestoreTheirState) {
  RouteFixture r;
  Route& route = r.route("a/friction", "b/linear_damping");
  r.set(route.id(), "smoothing", {0.1});
  r.set(route.id(), "lag", {0.05});
  const auto play = [&] {
    for (int n = 0; n < 7; n++) {
      r.input(0.1 * (n % 3));
      r.ticks(1);
    }
    return r.world.state_hash();
  };
  play();
  PageStore pages;
  Archive scratch;
  WorldCheckpoint checkpoint;
  checkpoint.capture(r.world, pages, nullptr, scratch);
  const std::uint64_t first = play();
  checkpoint.restore(r.world, pages, scratch);
  EXPECT_EQ(play(), first);
  checkpoint.release(pages);
}

TEST(Routes, AWorldWithoutRoutesKeepsItsHash) {
  RouteFixture r;
  r.ticks(3);
  const std::uint64_t before = r.world.state_hash();
  Route& route = r.route("a/friction", "b/friction");
  EXPECT_NE(r.world.state_hash(), before);
  r.routes().remove(route);
  EXPECT_EQ(r.world.state_hash(), before);
}

TEST(Routes, AFailedCallRestoresARemovedRoute) {
  RouteFixture r;
  Route& first = r.route("a/friction", "b/linear_damping");
  r.route("a/friction", "c/linear_damping");
  r.world.transaction().begin();
  r.routes().remove(first);
  EXPECT_EQ(r.routes().list().size(), 1u);
  ASSERT_TRUE(r.routes().add("new", "/a", "/b").ok());
  r.world.transaction().rollback();
  ASSERT_EQ(r.routes().list().size(), 2u);
  EXPECT_EQ(r.routes().list()[0].get(), &first);
  EXPECT_EQ(r.routes().find("new"), nullptr);
  r.input(0.5);
  r.ticks(1);
  EXPECT_EQ(r.damping(), 0.5);
  r.world.transaction().begin();
  r.routes().remove(first);
  r.world.transaction().commit();
  EXPECT_EQ(r.routes().find("route0"), nullptr);
  r.ticks(1);
}

}  // namespace
}  // namespace limber::sim
