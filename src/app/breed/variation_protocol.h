// The messages between `limber breed` and the child processes that play its variations. A process receives a setup and
// evaluations, as workers of experiments do (experiments/evaluation.h), each of which starts a run, and requests of
// images. It answers each request with a header, a line of JSON, and the bytes of the image. [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "app/view/window.h"

namespace limber::app {

/// Largest width and height of an image, pixels.
inline constexpr int kMaxVariationSize = 4096;

struct ImageRequest {
  int width = 0;  ///< Pixels, 1 to kMaxVariationSize.
  int height = 0;
  bool paused = false;
  bool follow = false;  ///< The camera follows the first body with joints.
  MouseMovement mouse;  ///< All movement of the camera so far; each run begins with the camera of the scene.
};

struct ImageHeader {
  std::uint64_t number = 0;  ///< Of the evaluation that plays.
  int width = 0;             ///< 0: there is no image yet.
  int height = 0;
  std::string error;  ///< Reason why it doesn't play as it should; empty: it does.

  /// Number of bytes that follow: four for each pixel (render::Pixels).
  std::size_t bytes() const { return 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Return one line without a line feed.
std::string encode(const ImageRequest& request);
std::string encode(const ImageHeader& header);
/// Return nullopt if the line is not such a message.
std::optional<ImageRequest> decode_image_request(std::string_view line);
std::optional<ImageHeader> decode_image_header(std::string_view line);

}  // namespace limber::app
