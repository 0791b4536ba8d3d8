// Checks requests that other modules carry out: about MIDI (src/net/midi) and the targets of OSC (src/net/osc). [any]
#pragma once

#include "base/message.h"
#include "engine/commands/outcome.h"

namespace limber::engine {

/// Returns a request, or the error in the arguments of /midi/learn, /midi/forget, /osc/target/… or /list/targets.
Outcome check_service_request(const Message& message);

}  // namespace limber::engine
