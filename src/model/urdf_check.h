// Our own pass over a URDF's XML, with line numbers: what is good goes on, what is not is left out and said.
#pragma once

#include <string>

#include "base/result.h"
#include "model/problems.h"
#include "model/urdf_file.h"

namespace limber {

inline constexpr int kMostUrdfLinks = 10000;

/// Reads cleaned text (clean_urdf_text). `fallback_name` is the robot's name when the file gives none. The error, for
/// text with no robot in it, starts with its line number and a colon. [any]
Result<UrdfFile> check_urdf(const std::string& text, const std::string& fallback_name, Problems& problems);

}  // namespace limber
