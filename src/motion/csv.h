// CSV: a row a frame; where every link is, how it is turned, what every joint stands at.
#pragma once

#include <memory>
#include <string>

#include "motion/motion.h"

namespace limber {

/// Memory does not grow with time: rows go to the disk as they come, and once more where a body came after the first
/// row, since the header has its columns then. The error names the file.
Result<std::unique_ptr<MotionWriter>> write_csv(const std::string& path);

}  // namespace limber
