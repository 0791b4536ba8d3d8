// View: draws images of a simulation offscreen. OpenGL is loaded with the first image. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/result.h"
#include "engine/engine.h"
#include "engine/output/publisher.h"
#include "lib/limber.h"
#include "ui/render/offscreen.h"
#include "ui/render/renderer.h"

namespace limber::lib {

class View {
 public:
  View() = default;
  /// Restores the context of the calling thread, as draw() does.
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// Draws an image and copies it to `pixels`, three bytes each. `image` must be valid (check_image()). Errors: there
  /// is no OpenGL, or the image is too large for it.
  Result<void> draw(engine::Engine& engine, const limber_image& image, std::uint8_t* pixels);

 private:
  Result<void> open(limber_quality quality);
  const engine::Snapshot& snapshot(engine::Engine& engine);

  std::unique_ptr<render::OffscreenContext> context_;
  std::unique_ptr<render::Renderer> renderer_;  // destroyed before its context
  limber_quality quality_ = LIMBER_QUALITY_HIGH;
  Latest<engine::Snapshot> snapshots_;
  std::shared_ptr<const engine::Snapshot> snapshot_;
  std::optional<engine::Publisher> publisher_;
  std::uint64_t runs_ = 0;  // History::clears() when the publisher was made
};

/// Error: the size of the structure, the image or the array, a camera that is not finite or looks at its own position,
/// an unknown quality.
Result<void> check_image(engine::Engine& engine, const limber_image& image, std::size_t size);

}  // namespace limber::lib
