// Axis: a varied parameter of an experiment, with its values or its range. [any]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber::experiments {

/// A parameter that a scene declares.
struct ParameterInfo {
  std::string name;
  double min = 0;  ///< May be infinite.
  double max = 0;
  double initial = 0;
  std::vector<std::string> choices;  ///< Words of a choice, whose value is the index; empty: a number.
  bool whole = false;                ///< A boolean or a choice: only whole numbers are values.

  bool operator==(const ParameterInfo&) const = default;
};

/// `--param NAME=VALUES` as typed: MIN:MAX, MIN:MAX:STEP, MIN:MAX/N, or a list of numbers or words.
struct AxisText {
  std::string name;
  std::vector<std::string> words;  ///< The items of a list; empty: a range.
  double min = 0;
  double max = 0;
  double step = 0;  ///< Step of the grid, or 0.
  int count = 0;    ///< Number of values of the grid, or 0.
};

/// Parses `--param`. The error shows the forms.
Result<AxisText> parse_axis(std::string_view text);

/// A varied parameter with its range. A grid uses `values`; random designs and searches use the range, or pick one of
/// `values` if `listed`.
struct Axis {
  std::string name;
  double min = 0;
  double max = 0;
  std::vector<double> values;  ///< Values of a grid or list, in the order of the text; empty: a range without a step.
  bool listed = false;         ///< Only `values` are valid: a list, a boolean or a choice.
  std::vector<std::string> choices;
  bool boolean = false;  ///< 0 or 1.

  /// Maps a position 0 .. 1 within the range to a value.
  double at(double position) const;
  /// Returns the position that at() maps to the value, or to the nearest one.
  double position_of(double value) const;
  /// Returns a value as text for people and for `--param`: a number or a word.
  std::string text(double value) const;
};

/// Maximum number of values of an axis, and of seeds.
inline constexpr std::size_t kMaxValues = 100'000;

/// Checks the text against the scene's parameter. Errors: a value outside the range, an unknown word.
Result<Axis> make_axis(const AxisText& text, const ParameterInfo& parameter);
/// An axis over the whole range of a parameter; error if it has none.
Result<Axis> whole_axis(const ParameterInfo& parameter);
/// Checks all texts against the parameters of a scene; without texts, uses all parameters that have a range.
Result<std::vector<Axis>> make_axes(const std::vector<AxisText>& texts, const std::vector<ParameterInfo>& parameters);

/// Parses `--seeds`: 1:5 is 1 to 5; lists such as 1,2,7.
Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text);

}  // namespace limber::experiments
