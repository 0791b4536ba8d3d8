// Walks over XML mark-up before any parser does, and blanks what must not reach one.
// Part of the room's inside: only urdf_text.cpp includes it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "model/problems.h"

namespace limber {

/// The line, from 1, of the character at `at`. [any]
int line_of(std::string_view text, std::size_t at);

/// Blanks declarations and too deep elements, puts bare attribute values in quotes, cuts what follows the first
/// element. Lines stay where they are. False when there is no element at all. Linear in time. [any]
bool clean_markup(std::string& text, Problems& problems);

}  // namespace limber
