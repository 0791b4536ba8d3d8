// Texts of --param and --seeds, and their checks against the parameters of a scene.
#include "experiments/axis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::experiments {

namespace {

constexpr std::string_view kForms =
    "write NAME=MIN:MAX:STEP (0.1:1:0.1), NAME=MIN:MAX/N (0.1:1/10), NAME=MIN:MAX, or a list (0.2,0.4)";
constexpr double kWholeSteps = 1e-9;  // tolerance for the last step of a grid

// the number of values in "0.1:1/10"
std::optional<int> parse_count(std::string_view text) {
  const std::optional<double> count = parse_number(text);
  if (!count || *count < 2 || *count > static_cast<double>(kMaxValues) || *count != std::floor(*count)) return {};
  return static_cast<int>(*count);
}

// "0.1:1:0.1", "0.1:1/10", "0.1:1"
std::optional<AxisText> parse_range(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  if (parts.size() < 2 || parts.size() > 3) return {};
  const bool has_step = parts.size() == 3;
  AxisText axis;
  std::string_view last = parts[1];
  if (const std::size_t slash = last.find('/'); slash != std::string_view::npos) {
    const std::optional<int> count = parse_count(last.substr(slash + 1));
    if (has_step || !count) return {};
    axis.count = *count;
    last = last.substr(0, slash);
  }
  const std::optional<double> min = parse_number(parts[0]);
  const std::optional<double> max = parse_number(last);
  const std::optional<double> step = has_step ? parse_number(parts[2]) : 1;
  if (!min || !max || !step || *min >= *max || *step <= 0) return {};
  axis.min = *min;
  axis.max = *max;
  if (has_step) axis.step = *step;
  return axis;
}

std::string range_of(const ParameterInfo& parameter) {
  return fmt::format("{} .. {}", number_text(parameter.min), number_text(parameter.max));
}

Result<double> value_of(const std::string& word, const ParameterInfo& parameter) {
  for (std::size_t i = 0; i < parameter.choices.size(); i++) {
    if (parameter.choices[i] == word) return static_cast<double>(i);
  }
  if (!parameter.choices.empty())
    return Error{fmt::format("--param {}: '{}' is none of its choices{}", parameter.name, printable(word),
                             name_hint(word, parameter.choices))};
  if (parameter.whole && (word == "true" || word == "false")) return word == "true" ? 1.0 : 0.0;
  const std::optional<double> number = parse_number(word);
  if (!number)
    return Error{fmt::format("--param {}: '{}' is not a number; {}", parameter.name, printable(word), kForms)};
  return *number;
}

std::vector<double> whole_numbers(double min, double max) {
  std::vector<double> values;
  for (double value = min; value <= max; value++) values.push_back(value);
  return values;
}

// the values of a grid over the range
std::vector<double> grid_values(const AxisText& text) {
  std::vector<double> values;
  if (text.count > 0) {
    for (int i = 0; i < text.count; i++)
      values.push_back(text.min + (text.max - text.min) * i / static_cast<double>(text.count - 1));
  } else if (text.step > 0) {
    const double steps = std::floor((text.max - text.min) / text.step + kWholeSteps);
    for (double i = 0; i <= std::min(steps, static_cast<double>(kMaxValues)); i++) {
      // the shortest number near it, so that 0.1:1:0.1 has 0.3 and not 0.30000000000000004
      const double value = text.min + i * text.step;
      const std::optional<double> rounded = parse_number(fmt::format("{:.12g}", value));
      values.push_back(std::min(rounded.value_or(value), text.max));
    }
  }
  return values;
}

}  // namespace

Result<AxisText> parse_axis(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size())
    return Error{fmt::format("--param '{}': {}", printable(text), kForms)};
  const std::string_view values = text.substr(equals + 1);
  AxisText axis;
  if (values.find(':') != std::string_view::npos) {
    const std::optional<AxisText> range = parse_range(values);
    if (!range) return Error{fmt::format("--param '{}': {}; MIN is below MAX, N at least 2", printable(text), kForms)};
    axis = *range;
  } else {
    for (const std::string_view word : split(values, ',')) {
      if (word.empty())
        return Error{fmt::format("--param '{}': an item of the list is empty; {}", printable(text), kForms)};
      axis.words.emplace_back(word);
    }
  }
  axis.name = text.substr(0, equals);
  return axis;
}

double Axis::at(double position) const {
  if (listed) {
    const auto index = static_cast<std::size_t>(position * static_cast<double>(values.size()));
    return values[std::min(index, values.size() - 1)];
  }
  return std::min(min + position * (max - min), max);
}

double Axis::position_of(double value) const {
  if (!listed) return max > min ? std::clamp((value - min) / (max - min), 0.0, 1.0) : 0;
  const auto nearest = std::ranges::min_element(values, {}, [&](double each) { return std::abs(each - value); });
  return (static_cast<double>(nearest - values.begin()) + 0.5) / static_cast<double>(values.size());
}

std::string Axis::text(double value) const {
  if (choices.empty()) return number_text(value);
  return choices[std::min(static_cast<std::size_t>(std::max(value, 0.0)), choices.size() - 1)];
}

Result<Axis> make_axis(const AxisText& text, const ParameterInfo& parameter) {
  Axis axis{parameter.name, text.min, text.max, {}, false, parameter.choices};
  axis.boolean = parameter.whole && parameter.choices.empty();
  if (!text.words.empty()) {
    axis.listed = true;
    for (const std::string& word : text.words) {
      const Result<double> value = value_of(word, parameter);
      if (!value) return Error{value.error()};
      axis.values.push_back(*value);
    }
    const auto [min, max] = std::ranges::minmax(axis.values);
    axis.min = min;
    axis.max = max;
  } else {
    axis.values = grid_values(text);
    axis.listed = parameter.whole;
  }
  if (axis.values.size() > kMaxValues)
    return Error{fmt::format("--param {}: more than {} values", parameter.name, kMaxValues)};
  const auto fits = [&](double value) {
    return value >= parameter.min && value <= parameter.max && (!parameter.whole || value == std::floor(value));
  };
  const bool fit = std::ranges::all_of(axis.values, fits) && fits(axis.min) && fits(axis.max);
  if (!fit)
    return Error{fmt::format("--param {}: values must be {} {}", parameter.name,
                             parameter.whole ? "whole numbers within" : "within", range_of(parameter))};
  // after the check of the range, which bounds their number
  if (axis.values.empty() && parameter.whole) axis.values = whole_numbers(axis.min, axis.max);
  return axis;
}

Result<Axis> whole_axis(const ParameterInfo& parameter) {
  if (!std::isfinite(parameter.min) || !std::isfinite(parameter.max) || parameter.min >= parameter.max)
    return Error{
        fmt::format("the parameter '{}' has no range; add min and max to its declaration, or --param {}=MIN:MAX",
                    parameter.name, parameter.name)};
  Axis axis{parameter.name, parameter.min, parameter.max, {}, parameter.whole, parameter.choices};
  axis.boolean = parameter.whole && parameter.choices.empty();
  if (parameter.whole) axis.values = whole_numbers(parameter.min, parameter.max);
  return axis;
}

Result<std::vector<Axis>> make_axes(const std::vector<AxisText>& texts, const std::vector<ParameterInfo>& parameters) {
  std::vector<Axis> axes;
  std::vector<std::string> names;
  names.reserve(parameters.size());
  for (const ParameterInfo& parameter : parameters) names.push_back(parameter.name);
  for (const AxisText& text : texts) {
    const auto found = std::ranges::find_if(
        parameters, [&](const ParameterInfo& parameter) { return same_name(parameter.name, text.name); });
    if (found == parameters.end())
      return Error{fmt::format("--param {}: the scene has no such parameter{}", printable(text.name),
                               name_hint(text.name, names))};
    if (std::ranges::find(axes, found->name, &Axis::name) != axes.end())
      return Error{fmt::format("--param {} is given twice; give all its values at once", found->name)};
    Result<Axis> axis = make_axis(text, *found);
    if (!axis) return Error{axis.error()};
    axes.push_back(std::move(*axis));
  }
  if (!texts.empty()) return axes;
  for (const ParameterInfo& parameter : parameters) {
    if (Result<Axis> axis = whole_axis(parameter)) axes.push_back(std::move(*axis));
  }
  if (!axes.empty()) return axes;
  return Error{parameters.empty() ? "the scene has no parameters; declare them with params { { \"name\", 0.5, min = 0, "
                                    "max = 1 } }"
                                  : "no parameter of the scene has a range; add min and max to its declaration, or "
                                    "--param NAME=MIN:MAX"};
}

Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text) {
  constexpr double kMaxSeed = 9007199254740992.0;
  const auto fault = [&] {
    return Error{fmt::format("--seeds '{}': write FIRST:LAST, such as 1:5, or a list, such as 1,2,7", printable(text))};
  };
  const bool range = text.find(':') != std::string_view::npos;
  std::vector<std::uint64_t> seeds;
  for (const std::string_view word : split(text, range ? ':' : ',')) {
    const std::optional<double> seed = parse_number(word);
    if (!seed || *seed < 0 || *seed > kMaxSeed || *seed != std::floor(*seed)) return fault();
    seeds.push_back(static_cast<std::uint64_t>(*seed));
  }
  if (!range) return seeds;
  if (seeds.size() != 2 || seeds[0] > seeds[1]) return fault();
  const std::uint64_t first = seeds[0];
  const std::uint64_t last = seeds[1];
  if (last - first >= kMaxValues)
    return Error{fmt::format("--seeds '{}': more than {} seeds", printable(text), kMaxValues)};
  seeds.clear();
  for (std::uint64_t seed = first; seed <= last; seed++) seeds.push_back(seed);
  return seeds;
}

}  // namespace limber::experiments
