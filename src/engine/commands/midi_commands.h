// Checks /midi/learn and /midi/forget, which src/net/midi carries out. [any]
#pragma once

#include "base/message.h"
#include "engine/commands/outcome.h"

namespace limber::engine {

/// Returns a request, or the error in the arguments.
Outcome check_midi_request(const Message& message);

}  // namespace limber::engine
