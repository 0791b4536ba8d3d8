// GltfModel: tracks and surfaces as a model of tinygltf, and the bytes behind it.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "motion/gltf_tracks.h"

namespace limber {

/// The text of a glTF file, and what the buffer that it speaks of holds.
struct GltfModel {
  std::string json;
  std::vector<std::string_view> pieces;  ///< One after the other they are the buffer; the tracks', or of `kept`.
  std::uint64_t bytes = 0;               ///< Of the buffer.
  std::deque<std::vector<float>> kept;
};

/// `name`: the animation's. `uri`: where the buffer is; empty: in the same file. The tracks outlive the answer. The
/// error names no file.
Result<GltfModel> gltf_model(const GltfTracks& tracks, const std::string& name, const std::string& uri);

}  // namespace limber
