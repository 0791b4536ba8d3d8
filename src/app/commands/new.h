// `limber new`: creates a commented template of a show, a scene or a behavior. Never overwrites existing files.
#pragma once

#include <string>

namespace limber {

/// Arguments of `new`.
struct NewCommand {
  enum class Kind : unsigned char { show, scene, behavior };
  Kind kind = Kind::scene;
  std::string name;  ///< For a show: its folder.
};

/// Returns the exit code: 1 if the file exists or the behavior's name is in use by another type, 2 if the name is
/// invalid, 3 if a file can't be written. [main]
int new_command(const NewCommand& command);

}  // namespace limber
