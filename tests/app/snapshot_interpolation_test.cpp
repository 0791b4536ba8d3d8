// Which snapshots a window draws, and when it has something new to draw.
#include "app/view/snapshot_interpolation.h"

#include <gtest/gtest.h>

#include "app/view/change_detector.h"

namespace limber::app::test {
namespace {

std::shared_ptr<const engine::Snapshot> snapshot_of(std::uint64_t tick, bool paused = false) {
  static const auto bodies = std::make_shared<const engine::BodyList>();
  auto snapshot = std::make_shared<engine::Snapshot>();
  snapshot->tick = tick;
  snapshot->paused = paused;
  snapshot->body_list = bodies;
  return snapshot;
}

TEST(SnapshotInterpolation, MixesConsecutiveTicks) {
  SnapshotInterpolation snapshots;
  EXPECT_TRUE(snapshots.empty());
  snapshots.add(snapshot_of(1), 10);
  snapshots.add(snapshot_of(2), 10.02);
  EXPECT_EQ(snapshots.previous().tick, 1u);
  EXPECT_EQ(snapshots.current().tick, 2u);
  EXPECT_NEAR(snapshots.mix(10.025), 0.25, 1e-9);
  EXPECT_EQ(snapshots.mix(11), 1);
}

TEST(SnapshotInterpolation, DrawsTheLatestAfterAJump) {
  SnapshotInterpolation snapshots;
  snapshots.add(snapshot_of(1), 10);
  snapshots.add(snapshot_of(5), 10.02);
  EXPECT_EQ(snapshots.previous().tick, 5u);
  EXPECT_EQ(snapshots.current().tick, 5u);
}

TEST(ChangeDetector, ReportsEachVisibleChangeOnce) {
  ChangeDetector changes;
  EXPECT_TRUE(changes.changed(snapshot_of(1, true), 640, 480, false));
  EXPECT_FALSE(changes.changed(snapshot_of(1, true), 640, 480, false));
  EXPECT_TRUE(changes.changed(snapshot_of(1, true), 640, 481, false));
  EXPECT_TRUE(changes.changed(snapshot_of(1, true), 640, 481, true)) << "input";
  EXPECT_TRUE(changes.changed(snapshot_of(2, true), 640, 481, false));
  EXPECT_TRUE(changes.changed(snapshot_of(3), 640, 481, false));
  EXPECT_TRUE(changes.changed(snapshot_of(3), 640, 481, false)) << "not paused";
}

}  // namespace
}  // namespace limber::app::test
