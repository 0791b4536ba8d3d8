// Declares the options of `play`, which `limber service install` accepts as well.
#pragma once

#include <string>

#include "app/show/play.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber::app {

/// Declares the options in `play`. `options` must outlive the command.
void add_play_options(CLI::App& play, PlayOptions& options);

/// Returns the error if `text` is not a whole number from 0 to 2^53; else an empty string.
std::string whole_number_fault(const std::string& text);

}  // namespace limber::app
