// The signals that end a run: blocked, so that they reach only who asks for them.
#pragma once

#include <csignal>

namespace limber {

/// From here on SIGINT, SIGTERM and SIGHUP, and SIGUSR1 by which a thread calls the main one, wait until somebody asks;
/// a pipe that closes and a file that may not grow are errors of the call alone. [main]
sigset_t block_signals();
/// Whether one of them has come; it is taken. [main]
bool signal_came(const sigset_t& signals);

}  // namespace limber
