// `limber new`: a commented start of a show, a scene, a behaviour. Nothing that is there is ever written over.
#pragma once

#include <string>

namespace limber {

struct NewCommand {
  enum class What : unsigned char { show, scene, behavior };
  What what = What::scene;
  std::string name;  ///< Of a show: its folder.
};

/// Returns the exit code: 1 when something is there already, or a behaviour's name is that of another type, 2 for a
/// name that can't be one, 3 when a file can't be written. [main]
int new_command(const NewCommand& command);

}  // namespace limber
