// BVH: a skeleton a body, as programs for motion capture take it. Y up, metres, degrees.
#pragma once

#include <memory>
#include <string>

#include "motion/motion.h"

namespace limber {

/// One file, where `path` ends with .bvh: a second body is an error then. Else a folder of that name with a file a
/// body; it must not be there. Memory does not grow with time.
Result<std::unique_ptr<MotionWriter>> write_bvh(const std::string& path, double rate);

/// Turns about z, x and y, rad: R = Rz·Rx·Ry, as the channels stand in the file. Of all that give R those nearest to
/// `before`, so that a turn never jumps.
Vec3 bvh_angles(const Quat& rotation, const Vec3& before);

}  // namespace limber
