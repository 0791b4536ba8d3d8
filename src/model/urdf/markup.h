// Sanitizes XML markup before it is parsed: blanks constructs that are unsafe or expensive for a parser.
// Internal to the module: only urdf_text.cpp includes it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "model/problems.h"

namespace limber {

/// The line (1-based) of the character at `at`. [any]
int line_of(std::string_view text, std::size_t at);

/// Blanks declarations, elements nested too deeply and surplus attributes, quotes unquoted attribute values, and
/// removes everything after the first element. Preserves line numbers. False if there is no element. Linear time. [any]
bool clean_markup(std::string& text, Problems& problems);

}  // namespace limber
