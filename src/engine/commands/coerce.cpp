// Conversion of message arguments to the numbers of a property.
#include "engine/commands/coerce.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/plural.h"
#include "base/text.h"
#include "sim/routes/own_axis.h"
#include "sim/world/world.h"

namespace limber::engine {

namespace {

bool is_gravity(const Property& property) {
  static const Property* const gravity = &sim::World::table().at("gravity");
  return &property == gravity;
}

bool is_flag(const Property& property) {
  return property.type == PropertyType::boolean || property.type == PropertyType::flags3;
}

bool has_labels(const Property& property) {
  return property.type == PropertyType::choice || property.type == PropertyType::boolean;
}

// True if one number is accepted, possibly expanded to three.
bool accepts_one(const Property& property) {
  return property.width == 1 || property.type == PropertyType::flags3 || property.own_axis || is_gravity(property);
}

bool accepts_count(const Property& property, std::size_t n) {
  if (property.kind == PropertyKind::action) return action_accepts_count(property, n);
  return n == property.width || (n == 1 && accepts_one(property));
}

std::optional<double> label_index(const Property& property, std::string_view text) {
  for (std::size_t i = 0; i < property.choices.size(); i++) {
    if (same_name(property.choices[i], text)) return static_cast<double>(i);
  }
  return {};
}

std::optional<double> bool_of(std::string_view text) {
  if (same_name(text, "true") || same_name(text, "on")) return 1;
  if (same_name(text, "false") || same_name(text, "off")) return 0;
  return {};
}

// Converts an argument to a number of this property, if possible.
std::optional<double> number_of(const Property& property, const Arg& arg) {
  if (arg.is_numeric()) return arg.number;
  if (!arg.is_text()) return {};
  if (property.type == PropertyType::choice) {
    if (const auto label = label_index(property, arg.text)) return label;
  }
  if (is_flag(property)) {
    if (const auto truth = bool_of(arg.text)) return truth;
  }
  return parse_number(arg.text);
}

std::string arg_text(const Arg& arg) {
  if (arg.is_text()) return fmt::format("'{}'", printable(arg.text));
  return arg.is_numeric() ? number_text(arg.number) : "an argument without a value";
}

Error wrong_count(const Property& property, std::size_t given) {
  return Error{fmt::format("takes {}, not {}", expected_text(property), given)};
}

}  // namespace

bool action_accepts_count(const Property& action, std::size_t numbers) {
  return numbers >= action.min_args && numbers <= action.max_args && (action.max_args < 3 || numbers % 3 == 0);
}

std::string expected_text(const Property& property) {
  if (property.kind == PropertyKind::action) {
    if (property.max_args == 0) return "no value";
    if (property.min_args == 0) return "no value or " + counted(property.max_args, "number");
    return property.min_args == property.max_args
               ? counted(property.min_args, "number")
               : fmt::format("{} or {} numbers", property.min_args, property.max_args);
  }
  if (property.type == PropertyType::choice) return fmt::format("one of {}", fmt::join(property.choices, ", "));
  if (property.type == PropertyType::boolean) return "true or false";
  if (property.type == PropertyType::flags3) return "1 or 3 times true or false";
  if (property.width == 1) return "1 number";
  return accepts_one(property) ? fmt::format("1 or {} numbers", property.width) : counted(property.width, "number");
}

Result<ValueSplit> split_value(const Property& property, std::span<const Arg> args) {
  std::size_t numbers = 0;
  while (numbers < args.size() && args[args.size() - 1 - numbers].is_numeric()) numbers++;
  if (accepts_count(property, numbers)) return ValueSplit{numbers, false};
  // text can be a number, a label or "true"
  std::size_t convertible = numbers;
  while (convertible < args.size() && number_of(property, args[args.size() - 1 - convertible])) convertible++;
  if (accepts_count(property, convertible)) return ValueSplit{convertible, false};
  // a word in place of a label is the value: coerce() reports the valid labels
  if (has_labels(property) && convertible == 0 && !args.empty() && args.back().is_text()) return ValueSplit{1, false};
  // bodies may be named "1": surplus leading numbers are names
  if (property.kind == PropertyKind::action) return wrong_count(property, convertible);
  const std::size_t words = args.size() - convertible;
  for (std::size_t names = 1; names + words <= 2 && names < convertible; names++) {
    if (accepts_count(property, convertible - names)) return ValueSplit{convertible - names, true};
  }
  return wrong_count(property, convertible);
}

Result<PropertyValues> coerce(const Property& property, std::span<const Arg> args) {
  PropertyValues result;
  if (!accepts_count(property, args.size())) return wrong_count(property, args.size());
  for (const Arg& arg : args) {
    const std::optional<double> value = number_of(property, arg);
    if (!value) return Error{fmt::format("takes {}, not {}", expected_text(property), arg_text(arg))};
    if (!std::isfinite(*value))
      return Error{fmt::format("takes {}; {} is not finite", expected_text(property), *value)};
    result.values[result.count++] = *value;
  }
  if (property.type == PropertyType::choice) {
    const double index = std::round(result.values[0]);
    if (index < property.min || index > property.max)
      return Error{fmt::format("takes {} (0 to {}), not {}", expected_text(property), property.max, result.values[0])};
  }
  if (property.type == PropertyType::quat) {
    const double* q = result.values.data();
    if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] < 1e-18)
      return Error{"takes a rotation x y z w; 0 0 0 0 is not a rotation"};
  }
  return result;
}

Result<PropertyValues> expand(const Store& store, NodeId node, const Property& property, const PropertyValues& given) {
  if (given.count == property.width) return given;
  PropertyValues expanded = given;
  expanded.count = property.width;
  if (property.type == PropertyType::flags3) {
    expanded.values = {given.values[0], given.values[0], given.values[0], 0};
    return expanded;
  }
  if (is_gravity(property)) {
    expanded.values = {0, 0, given.values[0], 0};
    return expanded;
  }
  const int axis = sim::own_axis_index(store, node, property);
  if (axis < 0) return Error{fmt::format("has no own axis for {}; give three numbers", property.name)};
  store.get(node, property, expanded.values.data());
  expanded.values[static_cast<std::size_t>(axis)] = given.values[0];
  return expanded;
}

}  // namespace limber::engine
