// CSV writer: one line per frame with the pose of every link and the value of every joint.
#pragma once

#include <memory>
#include <string>

#include "export/motion.h"

namespace limber {

/// Creates a writer. Memory use is independent of the number of frames: lines are written to disk as they arrive. If a
/// body was added after the first frame, finish() rewrites the file with the complete header. The error names the file.
Result<std::unique_ptr<MotionWriter>> write_csv(const std::string& path);

}  // namespace limber
