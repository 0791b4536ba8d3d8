// ChangeDetector: detects changes of what a window shows, so that an idle, paused show needs few frames.
#pragma once

#include <memory>

#include "engine/output/snapshot.h"

namespace limber::app {

/// [main]
class ChangeDetector {
 public:
  /// Returns true if the snapshot (may be null) or the window's size differs visibly from those of the last change, or
  /// `input` is set.
  bool changed(const std::shared_ptr<const engine::Snapshot>& newest, int width, int height, bool input);

 private:
  std::shared_ptr<const engine::Snapshot> last_;  // at the last change
  int width_ = 0;
  int height_ = 0;
};

}  // namespace limber::app
