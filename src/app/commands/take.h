// `limber take info`: prints the contents of a take.
#pragma once

#include <string>

namespace limber {

/// Arguments of `take info`.
struct TakeCommand {
  std::string file;
};

/// Prints to stdout. Returns 1 if the file is not a take or is damaged. A truncated take is valid. [main]
int take_command(const TakeCommand& command);

}  // namespace limber
