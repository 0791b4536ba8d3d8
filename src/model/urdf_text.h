// The first look at a URDF file: bytes into text that an XML parser can be shown safely. Lines stay where they were,
// so that every later complaint has the user's line number.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "model/problems.h"

namespace limber {

inline constexpr std::size_t kMostUrdfBytes = 32u << 20;
inline constexpr int kMostUrdfDepth = 64;

/// The whole of a regular file of at most `most` bytes; the error names the file and the cure. [any]
Result<std::string> read_whole_file(const std::string& path, std::size_t most);

/// Valid UTF-8 without NUL, DOCTYPE, processing instructions, elements nested deeper than 64 and anything after the
/// first element's end; what was taken out or converted is said in `problems`. An error when there is no XML at all.
/// [any]
Result<std::string> clean_urdf_text(std::string_view bytes, Problems& problems);

}  // namespace limber
