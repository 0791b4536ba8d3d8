// Which Limber this is: version, commit, and where an installed one keeps its data. The build writes the answers.
#pragma once

#include <string_view>

namespace limber {

/// "0.1.0". [any]
std::string_view version();

/// Short hash of the commit it was built from, with "+" when files differed from it; "unknown" outside a checkout.
/// [any]
std::string_view commit();

/// Where `cmake --install` puts scripts, urdf, behaviors_lua and shaders; it need not exist. [any]
std::string_view install_data_dir();

}  // namespace limber
