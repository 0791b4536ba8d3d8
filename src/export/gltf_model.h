// GltfModel: converts tracks and surfaces to glTF JSON and the pieces of its binary buffer.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "export/gltf_tracks.h"

namespace limber::exporter {

/// The JSON text of a glTF file and the contents of its buffer.
struct GltfModel {
  std::string json;
  std::vector<std::string_view> pieces;  ///< Concatenated, they are the buffer; views of the tracks or of `own_data`.
  std::uint64_t bytes = 0;               ///< Size of the buffer.
  std::deque<std::vector<float>> own_data;  ///< Owns the data that is not in the tracks.
};

/// Converts tracks. `name`: name of the animation. `uri`: file of the buffer; empty: in the same file. The tracks must
/// outlive the result. The error does not name the file.
Result<GltfModel> gltf_model(const GltfTracks& tracks, const std::string& name, const std::string& uri);

}  // namespace limber::exporter
