// Tap: tells the link's traffic what goes out, packet by packet. To be called while somebody watches only. [net]
#pragma once

#include <span>

#include "engine/traffic.h"
#include "osc/endpoint.h"

namespace limber {

/// Each message of a packet that was made here.
void note_sent(Traffic& traffic, const Endpoint& to, std::span<const char> packet);

}  // namespace limber
