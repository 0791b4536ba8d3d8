// `limber take info`: what a take holds.
#pragma once

#include <string>

namespace limber {

struct TakeCommand {
  std::string file;
};

/// The answer goes to stdout; 1: it is no take, or damaged. One that was cut off is fine. [main]
int take_command(const TakeCommand& command);

}  // namespace limber
