// Declares the options of `limber sweep` and `limber evolve`.
#pragma once

#include "app/experiments/experiment_options.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber::app {

/// Declare the commands in `app`. The commands' options must outlive it.
void add_sweep(CLI::App& app, SweepCommand& command);
void add_evolve(CLI::App& app, EvolveCommand& command);

}  // namespace limber::app
