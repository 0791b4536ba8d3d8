// Where the program's own data (scripts, urdf) is: beside the build, or where it was installed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limber {

/// The folder that holds scripts/ and urdf/ of this program: above the program's file (a checkout), share/limber beside
/// it, or the installed one; empty when there is none. [any]
std::string data_dir();

/// The printable text as one word of a shell: in quotes if it needs them. [any]
std::string shell_word(std::string_view text);

/// How a shell calls this program: "limber" where PATH leads to it, else the program's file, quoted. [any]
std::string program_command();

/// The folder of shaders/ among that data, which may be edited while it plays; empty when there is none. [any]
std::string shader_dir();

/// Where this user's programs keep what they remember of themselves, without / at the end: $XDG_STATE_HOME/limber, else
/// below ~/.local/state; empty when there is no home. [any]
std::string state_dir();

/// The file that a shell starts for this name: the first in PATH that may be executed; empty: none. [any]
std::string find_in_path(std::string_view name);

/// The file as given, else in the data folder; empty when neither is there. `looked` gets every place. [any]
std::string find_scene(std::string_view name, std::vector<std::string>& looked);

/// What is said when there is none: where it was looked for, and what a scene is.
std::string no_scene(std::string_view name, const std::vector<std::string>& looked);

}  // namespace limber
