// glTF 2.0 writer: bodies with meshes and one animation, for 3D editors and the web. Y up, meters.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "export/motion.h"

namespace limber {

/// Default limit of the animation's keyframes, bytes; few programs read larger files.
inline constexpr std::uint64_t kMaxGltfKeyBytes = std::uint64_t{1800} << 20u;

/// Creates a writer. A `path` that ends with .glb gives one file; .gltf a text file and NAME.bin. Keyframes are stored
/// in memory until finish(), 28 bytes per link and frame; more than `max_bytes` are an error.
Result<std::unique_ptr<MotionWriter>> write_gltf(const std::string& path, std::uint64_t max_bytes = kMaxGltfKeyBytes);

}  // namespace limber
