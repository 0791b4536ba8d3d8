// Converts the arguments of a message to the numbers of a property. It accepts several notations but no ambiguous
// value. [sim]
#pragma once

#include <array>
#include <span>
#include <string>

#include "base/message.h"
#include "properties/store.h"

namespace limber::engine {

/// Numbers for one property: the first `count` of `values`. One number may be expanded to three; see expand().
struct PropertyValues {
  std::array<double, 4> values{};
  std::uint32_t count = 0;
};

/// Splits the arguments of a message into names and value.
struct ValueSplit {
  std::size_t count = 0;   ///< Number of arguments, from the end, that form the value.
  bool ambiguous = false;  ///< Leading numbers count as names (a body may be named "1"): perhaps too many numbers.
};

/// Finds the value at the end of the arguments: numbers, or text that can be converted. The error names the expected
/// number of arguments.
Result<ValueSplit> split_value(const Property& property, std::span<const Arg> args);

/// Converts the arguments of a value to numbers: booleans to 1 and 0, labels to their index, text to the number in it.
/// Rejects NaN, infinities, unknown labels and rotations of length zero.
Result<PropertyValues> coerce(const Property& property, std::span<const Arg> args);

/// Expands one number for three axes to the values of this node: booleans to all axes, gravity to z, joints and motors
/// to their own axis (the other axes keep their value). It is an error if the joint has no own axis of this kind.
Result<PropertyValues> expand(const Store& store, NodeId node, const Property& property, const PropertyValues& given);

/// Returns the expected value for error messages: "3 numbers", "1 or 3 numbers", "one of off, spin, servo, spring".
std::string expected_text(const Property& property);

/// True if an action accepts this number of arguments. Vectors must be complete.
bool action_accepts_count(const Property& action, std::size_t numbers);

}  // namespace limber::engine
