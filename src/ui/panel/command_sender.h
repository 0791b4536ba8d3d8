// CommandSender: sends the panel's messages to the simulation and requests value snapshots.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/output/engine_link.h"

namespace limber::panel {

/// All times in seconds. [main]
class CommandSender {
 public:
  explicit CommandSender(engine::EngineLink& link) : link_(link) {}

  /// Sends a message for the next tick. Returns the number of the request for a value snapshot that follows it.
  std::uint64_t send(Message message, double now);
  /// Begins an undo step: later messages belong to it.
  void begin_edit() { edit_number_++; }
  /// The same, except in the middle of a drag. `dragging`: the user is still dragging.
  void begin_edit(bool dragging) {
    if (!std::exchange(dragging_, dragging)) begin_edit();
  }
  /// Ends a drag, so that the next edit is a separate undo step.
  void end_drag() { dragging_ = false; }

  /// Requests a value snapshot if it is time and the requested one has arrived. `latest` may be null.
  void update_request(const engine::ValueSnapshot* latest, double now);
  /// Returns the replies since the last call; valid until the next one.
  std::span<const engine::Outgoing> replies();

 private:
  void request(double now);

  engine::EngineLink& link_;
  std::uint16_t edit_number_ = 0;
  bool dragging_ = false;
  std::uint64_t last_request_ = 0;
  double last_request_time_ = 0;
  std::vector<engine::Outgoing> replies_;
};

}  // namespace limber::panel
