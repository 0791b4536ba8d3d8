// SnapshotInterpolation: the two snapshots between which a frame is drawn.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "engine/output/snapshot.h"

namespace limber::app {

/// Drawing lags one tick behind, so that there are two snapshots to interpolate. If ticks are more frequent than
/// frames, the latest snapshot is drawn. All times in seconds. [main]
class SnapshotInterpolation {
 public:
  static constexpr double kLongestInterval = 0.1;  ///< Longer gaps between snapshots are not interpolated.

  /// Adds the newest snapshot, which may be the one added before.
  void add(std::shared_ptr<const engine::Snapshot> newest, double now) {
    if (newest == current_) return;
    const bool continuous =
        current_ != nullptr && newest->tick == current_->tick + 1 && newest->render_scene == current_->render_scene;
    previous_ = continuous ? current_ : newest;
    if (continuous || current_ == nullptr) {
      interval_ = std::min(now - time_, kLongestInterval);
      time_ = now;
    }
    current_ = std::move(newest);
  }

  bool empty() const { return current_ == nullptr; }
  const engine::Snapshot& previous() const { return *previous_; }
  const engine::Snapshot& current() const { return *current_; }
  /// Position of a frame between previous() and current(), from 0 to 1.
  double mix(double now) const { return interval_ <= 0 ? 1 : std::clamp((now - time_) / interval_, 0.0, 1.0); }

 private:
  std::shared_ptr<const engine::Snapshot> previous_, current_;
  double time_ = 0;      // time at which current_ was added
  double interval_ = 0;  // time between previous_ and current_
};

}  // namespace limber::app
