// Declares the options of `limber export`.
#pragma once

#include "app/commands/commands.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber::app {

/// Declares the command in `app`. Its options must outlive it.
void add_export(CLI::App& app, ExportCommand& command);

}  // namespace limber::app
