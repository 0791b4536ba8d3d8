// The child process that plays a variation: a run of the scene in real time, and images of it
// (app/breed/variation_protocol.h).
#pragma once

#include <string_view>

#include "app/view/display_options.h"

namespace limber::app {

/// The first argument of the program that makes it such a process; --gl and --quality follow. It is not for users, so
/// no help lists it.
inline constexpr std::string_view kVariationArgument = "--variation-from-input";

/// Plays until its standard input ends. Returns the exit code. [main]
int run_variation_worker(const DisplayOptions& display);

}  // namespace limber::app
