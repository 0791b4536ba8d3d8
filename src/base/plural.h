// Counts in messages and labels: "1 body", "17 parts".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace limber {

/// Returns the noun in the singular or the plural. `many`: the plural, if it isn't the singular with an s: plural(2,
/// "body", "bodies"). [any]
std::string plural(std::uint64_t count, std::string_view one, std::string_view many = {});
/// Returns the number and its noun: "1 part", "17 parts". [any]
std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

}  // namespace limber
