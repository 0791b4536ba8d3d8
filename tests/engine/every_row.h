// For tests of every row through every face: one thing of each class of the scene "everything", and values to set.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/everything.h"
#include "params/catalog.h"
#include "sim/world.h"

namespace limber::engine_test {

/// A thing of a class: its path, the names that the seed's message takes, what it is in Lua.
struct Sample {
  const Table* table;
  std::string path;
  std::vector<std::string> names;
  std::string lua;
};

inline std::vector<Sample> samples(const Store& store) {
  const std::string arm = "/physics/body/arm";
  return {
      {&World::table(), "/physics/sim", {}, "sim"},
      {&Body::table(), "/physics/body/free", {}, "sim:body('free')"},
      {&Part::table(), arm + "/part/part_revolute", {"arm", "part_revolute"}, "sim:body('arm'):part('part_revolute')"},
      {&Joint::table(), arm + "/joint/revolute", {"arm", "revolute"}, "sim:body('arm'):joint('revolute')"},
      {&Motor::table(), arm + "/motor/revolute", {"arm", "revolute"}, "sim:body('arm'):motor('revolute')"},
      {&store.table(find_place(store, arm + "/behavior/wind").value().node),
       arm + "/behavior/wind",
       {},
       "sim:body('arm'):behavior('wind')"},
      {&store.table(find_place(store, "/physics/group/swarm").value().node),
       "/physics/group/swarm",
       {},
       "sim:group_behavior('swarm')"},
      {&Gear::table(), "/physics/gear/rack", {}, "sim:gear('rack')"},
      {&store.table(find_place(store, "/scene").value().node), "/scene", {}, "params"},
  };
}

/// A value in the row's range that is not its default.
inline std::vector<double> other_value(const Row& row) {
  if (row.type == RowType::boolean) return {row.name == "paused" || row.initial[0] == 0 ? 1.0 : 0.0};
  if (row.type == RowType::flags3) return {1, 0, 1};
  if (row.type == RowType::quat) return {0, 0, 0.6, 0.8};
  if (row.type == RowType::choice) return {row.max == row.initial[0] ? 0 : row.max};
  if (row.name == "place") return {2};  // there are two
  if (row.type == RowType::integer) return {row.min + 3};
  std::vector<double> values;
  for (std::uint32_t i = 0; i < row.width; i++) {
    const double v = 0.25 * (i + 1);
    values.push_back(v >= row.min && v <= row.max ? v : row.min + (row.max - row.min) * v);
  }
  return values;
}

/// The value as a scene writes it.
inline std::string lua_literal(const Row& row, const std::vector<double>& v) {
  const auto truth = [](double x) { return x != 0 ? "true" : "false"; };
  switch (row.type) {
    case RowType::boolean:
      return truth(v[0]);
    case RowType::choice:
      return "\"" + row.choices[static_cast<std::size_t>(v[0])] + "\"";
    case RowType::flags3:
      return fmt::format("{{ {}, {}, {} }}", truth(v[0]), truth(v[1]), truth(v[2]));
    case RowType::vec3:
      return fmt::format("vec3({}, {}, {})", v[0], v[1], v[2]);
    case RowType::quat:
      return fmt::format("quat({}, {}, {}, {})", v[0], v[1], v[2], v[3]);
    default:
      return number_text(v[0]);
  }
}

/// What a member holds as numbers, for print and osc:send; a choice as its label.
inline std::string lua_numbers(const Row& row, const std::string& member) {
  switch (row.type) {
    case RowType::vec3:
      return fmt::format("{0}.x, {0}.y, {0}.z", member);
    case RowType::quat:
      return fmt::format("{0}.x, {0}.y, {0}.z, {0}.w", member);
    case RowType::flags3:
      return fmt::format("{0}[1], {0}[2], {0}[3]", member);
    default:
      return member;
  }
}

inline bool is_measure(const Row& row) {
  if (row.name == "place") return false;  // no further than there are others
  return row.type == RowType::number || row.type == RowType::integer || row.type == RowType::vec3;
}

}  // namespace limber::engine_test
