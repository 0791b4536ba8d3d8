// EngineLink: everything that the outside may touch of a running engine. Commands in; snapshots, answers and the
// plan of ports out; counters. All of it may be used from any thread.
#pragma once

#include <functional>
#include <mutex>

#include "base/inbox.h"
#include "base/latest.h"
#include "engine/command.h"
#include "engine/snapshot.h"

namespace limber {

struct EngineLink {
  static constexpr std::size_t kMostItems = 65536;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;  ///< A datagram of 16 KiB may grow to 0.8 MiB.
  Inbox<Command> inbox{kMostItems, kMostBytes};
  Inbox<Outgoing> outbox{kMostItems, kMostBytes};
  Latest<Snapshot> snapshots;
  Latest<OscPlan> osc_plan;  ///< What the scene wishes; null until a scene has run, empty lists: it says nothing.
  Counters counters;

  /// Called after something was put into `outbox` or `osc_plan` (an eventfd of the network's, say). Set before start.
  std::function<void()> wake_network = [] {};
  /// Called when a parameter with `rerun` has changed: somebody calls Engine::reload(true), on a thread of his own.
  /// Null: the simulation runs the scene itself. Set before start.
  std::function<void()> rerun_scene;
  /// Called after something was put into `inbox`, so that a paused engine need not poll. Set by the engine.
  std::function<void()> wake_engine = [] {};
};

}  // namespace limber
