// Declares the options of `limber sweep`, `limber evolve` and `limber breed`.
#pragma once

#include "app/breed/breed.h"
#include "app/experiments/experiment_options.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber::app {

/// Declare the commands in `app`. The commands' options must outlive it.
void add_sweep(CLI::App& app, SweepCommand& command);
void add_evolve(CLI::App& app, EvolveCommand& command);
void add_breed(CLI::App& app, BreedCommand& command);

}  // namespace limber::app
