// Where this program's own file is.
#pragma once

#include <string>

namespace limber::system {

/// Absolute; empty when the system does not know it. [any]
std::string executable_path();

}  // namespace limber::system
