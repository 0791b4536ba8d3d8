// Declares the options of `inspect`.
#pragma once

#include "app/commands/commands.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber::app {

/// Declares the command and its options in `app`. `options` must outlive it.
void add_inspect(CLI::App& app, InspectCommand& options);

}  // namespace limber::app
