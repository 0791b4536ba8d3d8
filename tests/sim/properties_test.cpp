// Every property of the physical classes: its effect is measured, and setting it follows the general rules. A new
// property without an entry in a *_property_effects.cpp fails here.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "sim/property_effects.h"
#include "sim/stage.h"

namespace limber::sim {
namespace {

using namespace test;

struct NamedTable {
  const char* name;
  const PropertyTable* table;
};

std::array<NamedTable, 11> tables() {
  return {NamedTable{"World", &World::table()},  NamedTable{"Body", &Body::table()},
          NamedTable{"Part", &Part::table()},    NamedTable{"Joint", &Joint::table()},
          NamedTable{"Motor", &Motor::table()},  NamedTable{"Gear", &Gear::table()},
          NamedTable{"Imu", &imu_table()},       NamedTable{"RangeFinder", &range_finder_table()},
          NamedTable{"Zone", &zone_table()},     NamedTable{"Touch", &touch_table()},
          NamedTable{"Tendon", &Tendon::table()}};
}

TEST(Properties, HaveMeasuredEffects) {
  std::size_t count = 0;
  for (const NamedTable& t : tables()) {
    for (const Property& property : t.table->properties()) {
      if (!property.writable()) continue;
      count++;
      EXPECT_EQ(all_property_effects().count({t.name, property.name}), 1u)
          << t.name << "::" << property.name << " has no measured effect";
    }
  }
  EXPECT_EQ(all_property_effects().size(), count) << "an effect is measured for a property that does not exist";
}

using PropertyKey = std::pair<std::string, std::string>;

std::vector<PropertyKey> all_keys() {
  std::vector<PropertyKey> keys;
  for (const auto& [key, effect] : all_property_effects()) keys.push_back(key);
  return keys;
}

struct Effect : testing::TestWithParam<PropertyKey> {};

TEST_P(Effect, IsAsPredicted) { all_property_effects().at(GetParam())(); }

std::string key_name(const testing::TestParamInfo<PropertyKey>& info) {
  return info.param.first + "_" + info.param.second;
}

INSTANTIATE_TEST_SUITE_P(Property, Effect, testing::ValuesIn(all_keys()), key_name);

// A floor, and a robot with two revolute joints, a gear and a tendon between them, and a floating joint: at least one
// object of each class.
struct AllClasses : WorldFixture {
  AllClasses() {
    floor();
    Body& robot = body("robot");
    Part& base = part(robot, box_model(Vec3(0.2)), 1, {{0, 0, 1}, quat_identity()});
    Part& arm = part(robot, box_model(Vec3(0.2)), 1, {{0, 0, 2}, quat_identity()});
    Part& kite = part(robot, box_model(Vec3(0.2)), 1, {{0, 0, 3}, quat_identity()});
    Joint& hinge = *robot.add_joint("hinge", base, arm, model::JointType::revolute, {0, 0, 1.5}, {0, 1, 0}).value();
    Joint& string = *robot.add_joint("string", arm, kite, model::JointType::floating, {0, 0, 2.5}, {0, 0, 1}).value();
    Part& wing = part(robot, box_model(Vec3(0.2)), 1, {{0, 1, 1}, quat_identity()});
    Joint& side = *robot.add_joint("side", base, wing, model::JointType::revolute, {0, 0.5, 1}, {1, 0, 0}).value();
    nodes = {world.id(),
             robot.id(),
             base.id(),
             hinge.id(),
             robot.add_motor(hinge).value()->id(),
             string.id(),
             robot.add_motor(string).value()->id(),
             world.gears().add("gear", hinge, side, 2).value()->id(),
             world.tendons().add(robot, "tendon", {{&arm, {}}, {&wing, {}}}).value()->id()};
    for (const SensorKind kind : kSensorKinds)
      nodes.push_back(robot.sensors().add(Sensor::kind_name(kind), kind, kite).value()->id());
    world.flush();
  }
  std::vector<NodeId> nodes;
};

// Three valid values of a property.
std::vector<double> samples(const Property& property) {
  const double low = std::isfinite(property.min) ? property.min : -1e3;
  const double high = std::isfinite(property.max) ? property.max : 1e3;
  if (property.type == PropertyType::choice || property.type == PropertyType::boolean ||
      property.type == PropertyType::flags3)
    return {low, high};
  if (property.type == PropertyType::integer) return {low, std::floor((low + high) / 2), high};
  return {low, low + (high - low) * 0.3, high};
}

void set_and_read_back(WorldFixture& fixture, NodeId id, const Property& property) {
  for (const double v : samples(property)) {
    std::vector<double> given(property.width, v);
    if (property.type == PropertyType::quat) given = {0.5, -0.5, 0.5, 0.5};
    for (std::size_t i = 1; i < given.size() && property.type == PropertyType::flags3; i++) given[i] = 1 - given[i - 1];
    const Result<SetOutcome> outcome = fixture.store.set(id, property, given);
    ASSERT_TRUE(outcome) << outcome.error();
    EXPECT_FALSE(outcome->clamped) << property.name << " " << v;
    const std::vector<double> back = fixture.get(id, property.name);
    for (std::size_t i = 0; i < back.size(); i++)
      EXPECT_NEAR(back[i], given[i], 1e-12 * std::abs(given[i])) << property.name;
  }
}

TEST(Properties, ReadBackAsSet) {
  AllClasses all;
  for (const NodeId id : all.nodes) {
    for (const Property& property : all.store.table(id).properties()) {
      if (property.writable()) set_and_read_back(all, id, property);
    }
  }
}

TEST(Properties, ClampAtBothEnds) {
  AllClasses all;
  for (const NodeId id : all.nodes) {
    for (const Property& property : all.store.table(id).properties()) {
      const bool range = property.type == PropertyType::number || property.type == PropertyType::integer ||
                         property.type == PropertyType::vec3;
      if (!property.writable() || !range) continue;
      for (const double end : {property.min, property.max}) {
        ASSERT_TRUE(std::isfinite(end)) << property.name << " needs a range";
        const double beyond = end + (end == property.min ? -1 : 1) * std::max(1.0, std::abs(end));
        const Result<SetOutcome> outcome = all.store.set(id, property, std::vector<double>(property.width, beyond));
        ASSERT_TRUE(outcome) << outcome.error();
        EXPECT_TRUE(outcome->clamped) << property.name;
        for (const double v : all.get(id, property.name)) EXPECT_NEAR(v, end, 1e-12 * std::abs(end)) << property.name;
      }
    }
  }
}

TEST(Properties, RejectNanAndWrongCounts) {
  AllClasses all;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const NodeId id : all.nodes) {
    for (const Property& property : all.store.table(id).properties()) {
      if (!property.writable()) continue;
      const std::vector<double> before = all.get(id, property.name);
      for (const double bad : {nan, inf, -inf}) {
        for (std::uint32_t i = 0; i < property.width; i++) {
          std::vector<double> given = before;
          given[i] = bad;
          EXPECT_FALSE(all.store.set(id, property, given)) << property.name;
        }
      }
      EXPECT_FALSE(all.store.set(id, property, std::vector<double>(property.width + 1, 1.0))) << property.name;
      EXPECT_FALSE(all.store.set(id, property, std::vector<double>(property.width - 1, 1.0))) << property.name;
      EXPECT_EQ(all.get(id, property.name), before) << property.name;
    }
  }
}

TEST(Properties, ReadoutsAndActionsCannotBeSet) {
  AllClasses all;
  for (const NodeId id : all.nodes) {
    for (const Property& property : all.store.table(id).properties()) {
      if (property.writable()) continue;
      const std::vector<double> before = all.get(id, property.name);
      const Result<SetOutcome> outcome = all.store.set(id, property, std::vector<double>(property.width, 0.5));
      ASSERT_FALSE(outcome) << property.name;
      EXPECT_EQ(outcome.error(),
                all.store.path(id) + "/" + property.name +
                    (property.kind == PropertyKind::action ? " can be called, not set" : " can be read, not set"));
      EXPECT_EQ(all.get(id, property.name), before) << property.name;
    }
  }
}

TEST(Properties, HaveUnitsAndDescriptions) {
  for (const NamedTable& t : tables()) {
    for (const Property& property : t.table->properties()) {
      EXPECT_FALSE(property.doc.empty()) << property.name;
      EXPECT_EQ(t.table->find(property.name), &property) << property.name << " is ambiguous under the naming rule";
      EXPECT_EQ(property.invoke != nullptr, property.kind == PropertyKind::action) << property.name;
      for (std::uint32_t i = 0; i < property.width; i++) {
        EXPECT_GE(property.initial[i], property.min) << property.name;
        EXPECT_LE(property.initial[i], property.max) << property.name;
      }
    }
  }
}

}  // namespace
}  // namespace limber::sim
