// Coerce: from arguments to a row's numbers.
#include "engine/coerce.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "sim/world.h"

namespace limber {

namespace {

bool is_gravity(const Row& row) {
  static const Row* const gravity = &World::table().at("gravity");
  return &row == gravity;
}

bool is_flag(const Row& row) { return row.type == RowType::boolean || row.type == RowType::flags3; }

// one number may stand for three
bool takes_one(const Row& row) {
  return row.width == 1 || row.type == RowType::flags3 || row.own_axis || is_gravity(row);
}

bool counts(const Row& row, std::size_t n) {
  if (row.kind == RowKind::action) return takes_count(row, n);
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

// what an argument says for this row, if it says a number at all
std::optional<double> number_of(const Row& row, const Arg& arg) {
  if (arg.is_numeric()) return arg.number;
  if (!arg.is_text()) return {};
  if (row.type == RowType::choice) {
    if (const auto label = label_of(row, arg.text)) return label;
  }
  if (is_flag(row)) {
    if (const auto truth = truth_of(arg.text)) return truth;
  }
  return parse_number(arg.text);
}

std::string shown(const Arg& arg) {
  if (arg.is_text()) return fmt::format("'{}'", printable(arg.text));
  return arg.is_numeric() ? number_text(arg.number) : "an argument without a value";
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

Error wrong_count(const Row& row, std::size_t given) {
  return Error{fmt::format("takes {}, not {}", takes_text(row), given)};
}

}  // namespace

bool takes_count(const Row& action, std::size_t numbers) {
  return numbers >= action.min_args && numbers <= action.max_args && (action.max_args < 3 || numbers % 3 == 0);
}

std::string takes_text(const Row& row) {
  if (row.kind == RowKind::action) {
    if (row.max_args == 0) return "no value";
    if (row.min_args == 0) return fmt::format("no value or {} number{}", row.max_args, row.max_args == 1 ? "" : "s");
    return row.min_args == row.max_args ? fmt::format("{} numbers", row.min_args)
                                        : fmt::format("{} or {} numbers", row.min_args, row.max_args);
  }
  if (row.type == RowType::choice) return fmt::format("one of {}", fmt::join(row.choices, ", "));
  if (row.type == RowType::boolean) return "true or false";
  if (row.type == RowType::flags3) return "1 or 3 times true or false";
  if (row.width == 1) return "1 number";
  return takes_one(row) ? fmt::format("1 or {} numbers", row.width) : fmt::format("{} numbers", row.width);
}

Result<ValueSplit> split_value(const Row& row, std::span<const Arg> args) {
  std::size_t numbers = 0;
  while (numbers < args.size() && args[args.size() - 1 - numbers].is_numeric()) numbers++;
  if (counts(row, numbers)) return ValueSplit{numbers, false};
  // text may say a number, a label, "true"
  std::size_t said = numbers;
  while (said < args.size() && number_of(row, args[args.size() - 1 - said])) said++;
  if (counts(row, said)) return ValueSplit{said, false};
  // a word where a label should be: coerce will say which there are
  const bool labels = row.type == RowType::choice || row.type == RowType::boolean;
  if (labels && said == 0 && !args.empty() && args.back().is_text()) return ValueSplit{1, false};
  // somebody's body is called "1": numbers too many in front are names
  const std::size_t words = args.size() - said;
  for (std::size_t names = 1; row.kind != RowKind::action && names + words <= 2 && names < said; names++) {
    if (counts(row, said - names)) return ValueSplit{said - names, true};
  }
  return wrong_count(row, said);
}

Result<RowValues> coerce(const Row& row, std::span<const Arg> args) {
  RowValues result;
  if (!counts(row, args.size())) return wrong_count(row, args.size());
  for (const Arg& arg : args) {
    const std::optional<double> value = number_of(row, arg);
    if (!value) return Error{fmt::format("takes {}, not {}", takes_text(row), shown(arg))};
    if (!std::isfinite(*value)) return Error{fmt::format("takes {}; {} is none", takes_text(row), *value)};
    result.values[result.count++] = *value;
  }
  if (row.type == RowType::choice) {
    const double index = std::round(result.values[0]);
    if (index < row.min || index > row.max)
      return Error{fmt::format("takes {} (0 to {}), not {}", takes_text(row), row.max, result.values[0])};
  }
  if (row.type == RowType::quat) {
    const double* q = result.values.data();
    if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] < 1e-18)
      return Error{"takes a rotation x y z w; 0 0 0 0 is none"};
  }
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
