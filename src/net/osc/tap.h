// Logs sent packets in the message log. [net]
#pragma once

#include <span>

#include "engine/output/message_log.h"
#include "net/osc/endpoint.h"

namespace limber {

/// Logs each message of a packet that this program encoded. Costs a decoding, so call it only while the log is enabled.
void log_sent(MessageLog& message_log, const Endpoint& to, std::span<const char> packet);

}  // namespace limber
