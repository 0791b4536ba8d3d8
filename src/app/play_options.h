// The options of `play`, which `limber service install` takes as well.
#pragma once

#include <string>

#include "app/play.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace limber {

/// Declares them. The options outlive the command.
void add_play_options(CLI::App& play, PlayOptions& options);

/// The error of a value that must be a whole number from 0 to 2^53; empty: it is one.
std::string whole_number_fault(const std::string& text);

}  // namespace limber
