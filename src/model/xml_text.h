// Reads a URDF file and converts its bytes to text that is safe for an XML parser. Preserves line numbers, so that
// later messages refer to the lines of the user's file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/problems.h"

namespace limber::model {

inline constexpr std::size_t kMaxUrdfBytes = 32u << 20;
inline constexpr int kMaxUrdfDepth = 64;

/// Reads a regular file of at most `max_bytes`; the error names the file and a fix. [any]
Result<std::string> read_whole_file(const std::string& path, std::size_t max_bytes);

/// The line (1-based) of the character at `at`. [any]
int line_of(std::string_view text, std::size_t at);

/// Blanks declarations, elements nested too deeply and surplus attributes, quotes unquoted attribute values, and
/// removes everything after the first element. Preserves line numbers. False if there is no element. Linear time. [any]
bool clean_markup(std::string& text, Problems& problems);

/// Returns valid UTF-8 without NUL, DOCTYPE, processing instructions, elements nested deeper than kMaxUrdfDepth, and
/// anything after the first element; reports removals and conversions in `problems`. Errors if there is no XML element,
/// or for UTF-16 and too large files. [any]
Result<std::string> clean_urdf_text(std::string_view bytes, Problems& problems);

}  // namespace limber::model
