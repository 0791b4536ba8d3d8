// Offline pictures: stills and films of exact times, drawn as fast as it goes, with time left and a way to stop.
#pragma once

#include <functional>

#include "app/picture_options.h"
#include "engine/engine.h"

namespace limber {

/// How it ended.
struct Rendered {
  int code = 0;            ///< An exit code; what was wrong was said.
  bool cancelled = false;  ///< By `cancel`: what was drawn so far is whole.
};

/// The engine has started and nobody else runs it: it ticks on this thread. `cancel` is asked before each frame and
/// tick.
Rendered render(const PictureOptions& options, Engine& engine, EngineLink& link, std::optional<double> duration,
                const std::function<bool()>& cancel);

}  // namespace limber
