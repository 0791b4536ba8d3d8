// Outcome: the result of executing a message.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"
#include "properties/property_table.h"

namespace limber::engine {

struct Outcome {
  enum class Kind : std::uint8_t {
    applied,
    answered,       ///< `answers` must be sent to the sender.
    rejected,       ///< Rejected without a change; `error` is the reason.
    unknown,        ///< Unknown address; `error` suggests similar ones.
    take_request,   ///< A request about takes, which the engine executes at the end of the tick.
    cue_request,    ///< A request to start the cue that its argument names.
    midi_request,   ///< A request to learn or forget the MIDI control of an address.
    osc_request,    ///< A request about the targets of OSC.
    scene_request,  ///< A request about scenes, which needs file access: to be passed to EngineLink::on_scene_request.
  };
  Kind kind = Kind::applied;
  bool sets_override = false;         ///< A persistent property was set: an override, which a reset keeps.
  const Property* clamped = nullptr;  ///< A property with a value that was clamped to its range.
  std::string error;
  std::string warning;  ///< Warning about values that were skipped.
  std::vector<Message> answers;

  static Outcome answered() {
    Outcome outcome;
    outcome.kind = Kind::answered;
    return outcome;
  }
  static Outcome rejected(std::string reason) {
    Outcome outcome;
    outcome.kind = Kind::rejected;
    outcome.error = std::move(reason);
    return outcome;
  }
  static Outcome unknown(std::string reason) {
    Outcome outcome;
    outcome.kind = Kind::unknown;
    outcome.error = std::move(reason);
    return outcome;
  }
};

}  // namespace limber::engine
