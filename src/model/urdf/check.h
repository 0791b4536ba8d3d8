// Reads and validates a URDF's XML. Invalid elements are skipped and reported with their line numbers.
#pragma once

#include <string>

#include "base/result.h"
#include "model/problems.h"
#include "model/urdf/file.h"

namespace limber::model {

inline constexpr int kMaxUrdfLinks = 10000;

/// Parses text from clean_urdf_text(). `fallback_name` is the robot's name if the file has none. Errors only if the
/// text contains no usable robot; the error starts with a line number and a colon. [any]
Result<UrdfFile> check_urdf(const std::string& text, const std::string& fallback_name, Problems& problems);

}  // namespace limber::model
