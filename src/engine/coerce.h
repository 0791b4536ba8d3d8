// Coerce: arguments of a message into a row's numbers, generous in what it takes, never guessing. [sim]
#pragma once

#include <array>
#include <span>
#include <string>

#include "base/message.h"
#include "params/store.h"

namespace limber {

/// Numbers for one row: `count` of `values`. One number may stand for three (see `spread`).
struct RowValues {
  std::array<double, 4> values{};
  std::uint32_t count = 0;
};

/// Where a message's names end and its value begins.
struct ValueSplit {
  std::size_t count = 0;  ///< Arguments, from the end, that are the value.
  bool guessed = false;   ///< Numbers stand where names are: a body may be called "1", or there are too many numbers.
};

/// Finds the value at the end of the arguments: numbers, or text that says some. An error says what the row takes.
Result<ValueSplit> split_value(const Row& row, std::span<const Arg> args);

/// The value's arguments as numbers: booleans as 1 and 0, labels by the one naming rule, text that is a number.
/// Refuses NaN, infinities, a choice that there is not, a rotation of length zero.
Result<RowValues> coerce(const Row& row, std::span<const Arg> args);

/// The values as this node takes them: one number for three axes becomes all axes (booleans), the own axis (motors,
/// joints; the others stay), or z (gravity). An error where the thing has no own axis there.
Result<RowValues> spread(const Store& store, NodeId node, const Row& row, const RowValues& given);

/// "3 numbers", "1 or 3 numbers", "one of off, spin, servo, spring": what a row takes, for error texts.
std::string takes_text(const Row& row);

/// Whether an action takes so many numbers: vectors come whole.
bool takes_count(const Row& action, std::size_t numbers);

}  // namespace limber
