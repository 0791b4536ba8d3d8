// BVH writer: one motion capture skeleton per body. Y up, meters, degrees.
#pragma once

#include <memory>
#include <string>

#include "export/motion.h"

namespace limber {

/// Creates a writer. If `path` ends with .bvh, it writes one file, and a second body is an error; otherwise a folder of
/// that name, which must not exist, with one file per body. `rate`: frames per second. Memory use is independent of the
/// number of frames.
Result<std::unique_ptr<MotionWriter>> write_bvh(const std::string& path, double rate);

/// Returns the Euler angles about z, x and y, rad: R = Rz·Rx·Ry, the order of the channels in the file. Of all
/// equivalent angles, chooses those nearest to `previous`, so that a curve never jumps.
Vec3 bvh_angles(const Quat& rotation, const Vec3& previous);

}  // namespace limber
