// Coerce: arguments of a message into a row's numbers, generous in what it takes, never guessing. [sim]
#pragma once

#include <array>
#include <span>

#include "base/message.h"
#include "params/store.h"

namespace limber {

/// Numbers for one row: `count` of `values`. One number may stand for three (see `spread`).
struct RowValues {
  std::array<double, 4> values{};
  std::uint32_t count = 0;
};

/// How many arguments, from the end, are the row's value: numbers, or one label of a choice. An error says what the
/// row takes. `args` may begin with names; those are the rest.
Result<std::size_t> value_count(const Row& row, std::span<const Arg> args);

/// The value's arguments as numbers: booleans as 1 and 0, labels by the one naming rule, text that is a number.
/// Refuses NaN and infinities.
Result<RowValues> coerce(const Row& row, std::span<const Arg> args);

/// The values as this node takes them: one number for three axes becomes all axes (booleans), the own axis (motors,
/// joints; the others stay), or z (gravity). An error where the thing has no own axis there.
Result<RowValues> spread(const Store& store, NodeId node, const Row& row, const RowValues& given);

/// "3 numbers", "1 or 3 numbers", "one of off, spin, servo, spring": what a row takes, for error texts.
std::string takes_text(const Row& row);

}  // namespace limber
