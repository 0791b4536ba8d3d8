// The path of this program's executable.
#pragma once

#include <string>

namespace limber::system {

/// Returns the absolute path, or an empty string if it is unknown. [any]
std::string executable_path();

}  // namespace limber::system
