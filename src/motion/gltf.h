// glTF 2.0: bodies with meshes and one animation, as programs for pictures and the web take them. Y up, metres.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "motion/motion.h"

namespace limber {

/// Keys of the animation that a file may hold, bytes: more than that few programs read.
inline constexpr std::uint64_t kMostGltfKeys = std::uint64_t{1800} << 20u;

/// `path` ends with .glb: one file; with .gltf: a text beside NAME.bin. Keys are held in memory until finish(), 28
/// bytes a link and frame; past `most` of them an error says what to do.
Result<std::unique_ptr<MotionWriter>> write_gltf(const std::string& path, std::uint64_t most = kMostGltfKeys);

}  // namespace limber
