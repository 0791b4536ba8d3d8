// Publisher: makes the snapshot after each tick, and the list of bodies when bodies are added or removed. [sim]
#pragma once

#include <memory>

#include "base/threads/latest.h"
#include "engine/output/snapshot.h"
#include "sim/world/world.h"

namespace limber::engine {

class Publisher {
 public:
  Publisher(sim::World& world, Latest<Snapshot>& out) : world_(world), out_(out) {}

  /// Publishes a snapshot of the current state. `speed_factor`: measured simulated seconds per real second.
  /// `replayed`: a take is replayed.
  void publish(bool paused, double speed_factor, const PhaseTimes& times = {}, bool replayed = false);

 private:
  void update_body_list();

  sim::World& world_;
  Latest<Snapshot>& out_;
  std::shared_ptr<const BodyList> body_list_;
  std::shared_ptr<const RenderScene> render_scene_;
  std::uint64_t structure_version_ = 0;
};

}  // namespace limber::engine
