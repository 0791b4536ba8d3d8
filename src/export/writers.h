// The writers of the export formats. Each function creates one; its error names the file.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "export/motion.h"

namespace limber::exporter {

/// CSV: one line per frame with the pose of every link, the value of every joint and the extras of every body. Memory
/// use is independent of the number of frames: lines are written to disk as they arrive. If a body was added after the
/// first frame, finish() rewrites the file with the complete header.
Result<std::unique_ptr<MotionWriter>> make_csv_writer(const std::string& path);

/// BVH: one motion capture skeleton per body. Y up, meters, degrees. If `path` ends with .bvh, it writes one file, and
/// a second body is an error; otherwise a folder of that name, which must not exist, with one file per body. `rate`:
/// frames per second. Memory use is independent of the number of frames.
Result<std::unique_ptr<MotionWriter>> make_bvh_writer(const std::string& path, double rate);

/// Returns the Euler angles about z, x and y, rad: R = Rz·Rx·Ry, the order of the channels in a BVH file. Of all
/// equivalent angles, chooses those nearest to `previous`, so that a curve never jumps.
Vec3 bvh_angles(const Quat& rotation, const Vec3& previous);

/// Default limit of a glTF animation's keyframes, bytes; few programs read larger files.
inline constexpr std::uint64_t kMaxGltfKeyBytes = std::uint64_t{1800} << 20u;

/// glTF 2.0: bodies with meshes and one animation, for 3D editors and the web. Y up, meters. A `path` that ends with
/// .glb gives one file; .gltf a text file and NAME.bin. Keyframes are stored in memory until finish(), 28 bytes per
/// link and frame; more than `max_bytes` are an error.
Result<std::unique_ptr<MotionWriter>> make_gltf_writer(const std::string& path,
                                                       std::uint64_t max_bytes = kMaxGltfKeyBytes);

}  // namespace limber::exporter
