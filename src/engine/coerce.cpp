// Coerce: from arguments to a row's numbers.
#include "engine/coerce.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/text.h"
#include "sim/world.h"

namespace limber {

namespace {

bool is_gravity(const Row& row) { return &row == &World::table().at("gravity"); }

// one number may stand for three
bool takes_one(const Row& row) {
  return row.width == 1 || row.type == RowType::flags3 || row.own_axis || is_gravity(row);
}

bool counts(const Row& row, std::size_t n) {
  if (row.kind == RowKind::action) return n >= row.min_args && n <= row.max_args && (n % 3 == 0 || row.max_args < 3);
  return n == row.width || (n == 1 && takes_one(row));
}

std::optional<double> label_of(const Row& row, std::string_view text) {
  for (std::size_t i = 0; i < row.choices.size(); i++) {
    if (same_name(row.choices[i], text)) return static_cast<double>(i);
  }
  return {};
}

std::optional<double> truth_of(std::string_view text) {
  if (same_name(text, "true") || same_name(text, "on")) return 1;
  if (same_name(text, "false") || same_name(text, "off")) return 0;
  return {};
}

// the own axis's place among three, for linear or angular rows of a joint or motor; -1: none there
int own_place(const Store& store, NodeId node, const Row& row) {
  const Table* table = &store.table(node);
  int own = -1;
  if (table == &Joint::table()) own = static_cast<const Joint*>(store.thing(node))->own_axis();
  if (table == &Motor::table()) own = static_cast<const Motor*>(store.thing(node))->joint().own_axis();
  if (own < 0) return -1;
  const bool angular = row.name.find("angular") != std::string::npos;
  return (own >= 3) == angular ? own % 3 : -1;
}

}  // namespace

std::string takes_text(const Row& row) {
  if (row.kind == RowKind::action) {
    if (row.max_args == 0) return "no value";
    return row.min_args == row.max_args ? fmt::format("{} numbers", row.min_args)
                                        : fmt::format("{} or {} numbers", row.min_args, row.max_args);
  }
  if (row.type == RowType::choice) return fmt::format("one of {}", fmt::join(row.choices, ", "));
  if (row.type == RowType::boolean) return "true or false";
  if (row.width == 1) return "1 number";
  return takes_one(row) ? fmt::format("1 or {} numbers", row.width) : fmt::format("{} numbers", row.width);
}

Result<std::size_t> value_count(const Row& row, std::span<const Arg> args) {
  std::size_t numbers = 0;
  while (numbers < args.size() && args[args.size() - 1 - numbers].is_numeric()) numbers++;
  const bool labels = row.type == RowType::choice || row.type == RowType::boolean;
  if (numbers == 0 && labels && !args.empty() && args.back().is_text()) return std::size_t{1};
  if (counts(row, numbers)) return numbers;
  // somebody's body is called "1": a number too many in front is a name
  for (const std::size_t names : {std::size_t{1}, std::size_t{2}}) {
    if (row.kind != RowKind::action && numbers > names && numbers == args.size() && counts(row, numbers - names)) {
      return numbers - names;
    }
  }
  return Error{fmt::format("takes {}, not {}", takes_text(row), numbers)};
}

Result<RowValues> coerce(const Row& row, std::span<const Arg> args) {
  RowValues result;
  if (args.size() > result.values.size() && row.kind != RowKind::action) {
    return Error{fmt::format("takes {}, not {}", takes_text(row), args.size())};
  }
  for (const Arg& arg : args) {
    std::optional<double> value;
    if (arg.is_numeric()) {
      value = arg.number;
    } else if (arg.is_text() && row.type == RowType::choice) {
      value = label_of(row, arg.text);
    } else if (arg.is_text()) {
      value = parse_number(arg.text);
      const bool flag = row.type == RowType::boolean || row.type == RowType::flags3;
      if (!value && flag) value = truth_of(arg.text);
    }
    if (!value) return Error{fmt::format("takes {}, not '{}'", takes_text(row), arg.text)};
    if (!std::isfinite(*value)) return Error{fmt::format("takes {}; {} is none", takes_text(row), *value)};
    result.values[result.count++] = *value;
  }
  if (!counts(row, result.count)) return Error{fmt::format("takes {}, not {}", takes_text(row), result.count)};
  return result;
}

Result<RowValues> spread(const Store& store, NodeId node, const Row& row, const RowValues& given) {
  if (given.count == row.width) return given;
  RowValues all = given;
  all.count = row.width;
  if (row.type == RowType::flags3) {
    all.values = {given.values[0], given.values[0], given.values[0], 0};
    return all;
  }
  if (is_gravity(row)) {
    all.values = {0, 0, given.values[0], 0};
    return all;
  }
  const int place = own_place(store, node, row);
  if (place < 0) return Error{fmt::format("has no own axis for {}; give three numbers", row.name)};
  store.get(node, row, all.values.data());
  all.values[static_cast<std::size_t>(place)] = given.values[0];
  return all;
}

}  // namespace limber
