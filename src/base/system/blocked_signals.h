// The set of signals that block_signals() blocks. Private to base/system.
#pragma once

#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>

#include "base/system/signals.h"

namespace limber::system {

sigset_t blocked_signals();
/// Converts a signal number; numbers below 1 are Signal::none.
Signal signal_from_number(int signal);

}  // namespace limber::system
