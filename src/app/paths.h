// Locates the program's data (scripts, urdf, shaders) and the user's folders.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limber::app {

/// Returns the folder that holds scripts/ and urdf/: above the executable (in a checkout), share/limber next to it, or
/// the installed one; empty if there is none. [any]
std::string data_dir();

/// Returns the text, made printable, as one word for a shell, quoted if necessary. [any]
std::string shell_word(std::string_view text);

/// Returns the command that starts this program in a shell: "limber" if PATH finds it, else the quoted path. [any]
std::string program_command();

/// Returns the program limber-link: beside this program, else as PATH finds it. [any]
std::string link_program();

/// Returns the file of a module such as limber-mpi-mpich.so: beside this program, else in lib/limber next to the
/// installed one; empty if there is none. [any]
std::string module_file(std::string_view name);

/// Returns the folder of the shaders, which may be edited while the program runs; empty if there is none. [any]
std::string shader_dir();

/// Returns the folder with the pages of the documentation: build/site in a checkout, share/doc/limber/html next to an
/// installed program; empty if there is none. [any]
std::string site_dir();

/// Returns the folder for the user's persistent state, without a trailing /: $XDG_STATE_HOME/limber, else the same
/// below ~/.local/state; empty if there is no home folder. [any]
std::string state_dir();

/// Returns the executable that a shell would start for this name: the first in PATH; empty: not found. [any]
std::string find_in_path(std::string_view name);

/// Returns the file or folder as given, else in the data folder; empty if neither exists. `searched` receives all paths
/// that were tried. [any]
std::string find_file_or_folder(std::string_view name, std::vector<std::string>& searched);

/// Returns the path from the root folder, without `.` and `..`; as given if it is empty or the current folder is gone.
/// [any]
std::string absolute_path(const std::string& path);

/// Returns the error message for a missing scene or model: the places searched, and what can be played.
std::string scene_not_found(std::string_view name, const std::vector<std::string>& searched);

}  // namespace limber::app
