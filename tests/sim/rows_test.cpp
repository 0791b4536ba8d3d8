// Every row of the physical classes: what it does is measured, and its door keeps its promises. A new row without a
// line in a *_row_effects.cpp fails here.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "sim/row_effects.h"
#include "sim/stage.h"

namespace limber {
namespace {

using namespace test;

struct NamedTable {
  const char* name;
  const Table* table;
};

std::array<NamedTable, 6> tables() {
  return {NamedTable{"World", &World::table()}, NamedTable{"Body", &Body::table()},
          NamedTable{"Part", &Part::table()},   NamedTable{"Joint", &Joint::table()},
          NamedTable{"Motor", &Motor::table()}, NamedTable{"Gear", &Gear::table()}};
}

TEST(Rows, EachHasAMeasuredEffect) {
  std::size_t count = 0;
  for (const NamedTable& t : tables()) {
    for (const Row& row : t.table->rows()) {
      if (!row.writable()) continue;
      count++;
      EXPECT_EQ(row_effects().count({t.name, row.name}), 1u)
          << t.name << "::" << row.name << " has no line that measures what it does";
    }
  }
  EXPECT_EQ(row_effects().size(), count) << "a line measures a row that is gone";
}

using Key = std::pair<std::string, std::string>;

std::vector<Key> all_keys() {
  std::vector<Key> keys;
  for (const auto& [key, effect] : row_effects()) keys.push_back(key);
  return keys;
}

struct Effect : testing::TestWithParam<Key> {};

TEST_P(Effect, IsAsPredicted) { row_effects().at(GetParam())(); }

std::string key_name(const testing::TestParamInfo<Key>& info) { return info.param.first + "_" + info.param.second; }

INSTANTIATE_TEST_SUITE_P(Row, Effect, testing::ValuesIn(all_keys()), key_name);

// One of everything: a floor, and a robot with two revolute joints, a gear between them, and a floating joint.
struct Everything : Stage {
  Everything() {
    floor();
    Body& robot = body("robot");
    Part& base = part(robot, box_model(Vec3(0.2)), 1, {{0, 0, 1}, quat_identity()});
    Part& arm = part(robot, box_model(Vec3(0.2)), 1, {{0, 0, 2}, quat_identity()});
    Part& kite = part(robot, box_model(Vec3(0.2)), 1, {{0, 0, 3}, quat_identity()});
    Joint& hinge = *robot.add_joint("hinge", base, arm, JointType::revolute, {0, 0, 1.5}, {0, 1, 0}).value();
    Joint& string = *robot.add_joint("string", arm, kite, JointType::floating, {0, 0, 2.5}, {0, 0, 1}).value();
    Part& wing = part(robot, box_model(Vec3(0.2)), 1, {{0, 1, 1}, quat_identity()});
    Joint& side = *robot.add_joint("side", base, wing, JointType::revolute, {0, 0.5, 1}, {1, 0, 0}).value();
    nodes = {world.id(),
             robot.id(),
             base.id(),
             hinge.id(),
             robot.add_motor(hinge).value()->id(),
             string.id(),
             robot.add_motor(string).value()->id(),
             world.add_gear("gear", hinge, side, 2).value()->id()};
    world.settle();
  }
  std::vector<NodeId> nodes;
};

// Three values that a row can hold.
std::vector<double> samples(const Row& row) {
  const double low = std::isfinite(row.min) ? row.min : -1e3;
  const double high = std::isfinite(row.max) ? row.max : 1e3;
  if (row.type == RowType::choice || row.type == RowType::boolean || row.type == RowType::flags3) return {low, high};
  if (row.type == RowType::integer) return {low, std::floor((low + high) / 2), high};
  return {low, low + (high - low) * 0.3, high};
}

void set_and_read_back(Stage& stage, NodeId id, const Row& row) {
  for (const double v : samples(row)) {
    std::vector<double> given(row.width, v);
    if (row.type == RowType::quat) given = {0.5, -0.5, 0.5, 0.5};
    for (std::size_t i = 1; i < given.size() && row.type == RowType::flags3; i++) given[i] = 1 - given[i - 1];
    const Result<SetOutcome> outcome = stage.store.set(id, row, given);
    ASSERT_TRUE(outcome) << outcome.error();
    EXPECT_FALSE(outcome->clamped) << row.name << " " << v;
    const std::vector<double> back = stage.get(id, row.name);
    for (std::size_t i = 0; i < back.size(); i++)
      EXPECT_NEAR(back[i], given[i], 1e-12 * std::abs(given[i])) << row.name;
  }
}

TEST(Rows, AreReadBackAsSet) {
  Everything all;
  for (const NodeId id : all.nodes) {
    for (const Row& row : all.store.table(id).rows()) {
      if (row.writable()) set_and_read_back(all, id, row);
    }
  }
}

TEST(Rows, ClampAtBothEnds) {
  Everything all;
  for (const NodeId id : all.nodes) {
    for (const Row& row : all.store.table(id).rows()) {
      const bool range = row.type == RowType::number || row.type == RowType::integer || row.type == RowType::vec3;
      if (!row.writable() || !range) continue;
      for (const double end : {row.min, row.max}) {
        ASSERT_TRUE(std::isfinite(end)) << row.name << " needs a range";
        const double beyond = end + (end == row.min ? -1 : 1) * std::max(1.0, std::abs(end));
        const Result<SetOutcome> outcome = all.store.set(id, row, std::vector<double>(row.width, beyond));
        ASSERT_TRUE(outcome) << outcome.error();
        EXPECT_TRUE(outcome->clamped) << row.name;
        for (const double v : all.get(id, row.name)) EXPECT_NEAR(v, end, 1e-12 * std::abs(end)) << row.name;
      }
    }
  }
}

TEST(Rows, RefuseWhatIsNoNumberAndAWrongCount) {
  Everything all;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const NodeId id : all.nodes) {
    for (const Row& row : all.store.table(id).rows()) {
      if (!row.writable()) continue;
      const std::vector<double> before = all.get(id, row.name);
      for (const double bad : {nan, inf, -inf}) {
        for (std::uint32_t i = 0; i < row.width; i++) {
          std::vector<double> given = before;
          given[i] = bad;
          EXPECT_FALSE(all.store.set(id, row, given)) << row.name;
        }
      }
      EXPECT_FALSE(all.store.set(id, row, std::vector<double>(row.width + 1, 1.0))) << row.name;
      EXPECT_FALSE(all.store.set(id, row, std::vector<double>(row.width - 1, 1.0))) << row.name;
      EXPECT_EQ(all.get(id, row.name), before) << row.name;
    }
  }
}

TEST(Rows, ReadoutsAndActionsCannotBeSet) {
  Everything all;
  for (const NodeId id : all.nodes) {
    for (const Row& row : all.store.table(id).rows()) {
      if (row.writable()) continue;
      const std::vector<double> before = all.get(id, row.name);
      const Result<SetOutcome> outcome = all.store.set(id, row, std::vector<double>(row.width, 0.5));
      ASSERT_FALSE(outcome) << row.name;
      EXPECT_EQ(outcome.error(), all.store.path(id) + "/" + row.name +
                                     (row.kind == RowKind::action ? " can be done, not set" : " can be read, not set"));
      EXPECT_EQ(all.get(id, row.name), before) << row.name;
    }
  }
}

TEST(Rows, StandInOneTableWithUnitAndText) {
  for (const NamedTable& t : tables()) {
    for (const Row& row : t.table->rows()) {
      EXPECT_FALSE(row.doc.empty()) << row.name;
      EXPECT_EQ(t.table->find(row.name), &row) << row.name << " stands twice, for the one naming rule";
      EXPECT_EQ(row.act != nullptr, row.kind == RowKind::action) << row.name;
      for (std::uint32_t i = 0; i < row.width; i++) {
        EXPECT_GE(row.initial[i], row.min) << row.name;
        EXPECT_LE(row.initial[i], row.max) << row.name;
      }
    }
  }
}

}  // namespace
}  // namespace limber
