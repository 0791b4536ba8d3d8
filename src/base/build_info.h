// Version, commit and data folder of this build. CMake generates the implementation.
#pragma once

#include <string_view>

namespace limber {

/// Returns the version: "0.2.0". [any]
std::string_view version();

/// Returns the short hash of the commit, with "+" if files were modified; "unknown" if it was not built from a
/// checkout. [any]
std::string_view commit();

/// Returns the folder where `cmake --install` puts scripts, urdf, behaviors_lua and shaders; it may not exist. [any]
std::string_view install_data_dir();

}  // namespace limber
