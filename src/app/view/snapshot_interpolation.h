// SnapshotInterpolation: the two snapshots between which a frame is drawn.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "engine/output/snapshot.h"

namespace limber {

/// Drawing lags one tick behind, so that there are two snapshots to interpolate. If ticks are more frequent than
/// frames, the latest snapshot is drawn. All times in seconds. [main]
class SnapshotInterpolation {
 public:
  static constexpr double kLongestInterval = 0.1;  ///< Longer gaps between snapshots are not interpolated.

  /// Adds the newest snapshot, which may be the one added before.
  void add(std::shared_ptr<const Snapshot> newest, double now) {
    if (newest == now_) return;
    const bool moves = now_ != nullptr && newest->tick == now_->tick + 1 && newest->render_scene == now_->render_scene;
    before_ = moves ? now_ : newest;
    if (moves || now_ == nullptr) {
      interval_ = std::min(now - time_, kLongestInterval);
      time_ = now;
    }
    now_ = std::move(newest);
  }

  bool empty() const { return now_ == nullptr; }
  const Snapshot& before() const { return *before_; }
  const Snapshot& now() const { return *now_; }
  /// Position of a frame between before() and now(), from 0 to 1.
  double mix(double now) const { return interval_ <= 0 ? 1 : std::clamp((now - time_) / interval_, 0.0, 1.0); }

 private:
  std::shared_ptr<const Snapshot> before_, now_;
  double time_ = 0;      // time at which now_ was added
  double interval_ = 0;  // time between before_ and now_
};

}  // namespace limber
