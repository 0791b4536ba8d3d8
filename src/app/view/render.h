// Offline rendering: still images and films of exact simulated times, at full speed, with progress and cancellation.
#pragma once

#include <functional>

#include "app/view/display_options.h"
#include "engine/engine.h"

namespace limber::app {

/// Result of a rendering.
struct RenderResult {
  int code = 0;           ///< Exit code; an error was already printed.
  bool canceled = false;  ///< Stopped by `cancel`; the frames drawn so far are complete.
};

/// Renders as the options say. The engine must be started and not running elsewhere: it ticks on this thread. `cancel`
/// is called before each frame and tick, and returns true to stop.
RenderResult render(const DisplayOptions& options, engine::Engine& engine, engine::EngineLink& link,
                    std::optional<double> duration, const std::function<bool()>& cancel);

}  // namespace limber::app
