// The signals that block_signals() blocks. For base/system alone.
#pragma once

#include <signal.h>  // NOLINT(modernize-deprecated-headers): POSIX has more than <csignal>

#include "base/system/signals.h"

namespace limber::system {

sigset_t blocked_signals();
/// Of a signal's number; none below 1.
Signal kind_of(int signal);

}  // namespace limber::system
