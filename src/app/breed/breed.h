// `limber breed`: variations of a scene side by side, selected by eye. [main]
#pragma once

#include <string>
#include <vector>

#include "app/experiments/experiment_options.h"
#include "app/view/display_options.h"

namespace limber::app {

struct BreedCommand {
  ExperimentOptions common;  ///< `scene`, `params`, and `seeds`: one seed.
  std::uint64_t search_seed = 1;
  std::string presets;            ///< File for kept variations; empty: that of the scene.
  std::vector<std::string> from;  ///< Names of presets to begin with; empty: the values of the scene.
  DisplayOptions display;
};
/// Returns 1 if the scene has an error, 2 for wrong usage, 3 without a window.
int breed_command(const BreedCommand& command);

}  // namespace limber::app
