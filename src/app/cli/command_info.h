// The command line as plain data, and the manual page, the page of the reference and the completions for shells that
// are generated from it, so that no option is missing.
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber::app {

/// One option, flag or positional argument.
struct OptionInfo {
  std::vector<std::string> names;    ///< "-e", "--evaluate", as typed; empty: a positional argument.
  std::string value;                 ///< Name of its value, "SCENE.lua"; empty: a flag.
  std::string range;                 ///< "0.5 to 4"; empty: none.
  std::string about;                 ///< Help text.
  std::vector<std::string> choices;  ///< Words that are valid values; more values may be valid.
  bool required = false;
  bool repeats = false;  ///< May be given several times, or takes several values.
};

/// One command. The program itself is the outermost one.
struct CommandInfo {
  std::string name;
  std::string about;
  std::string footer;  ///< Help text after the options, usually examples.
  std::vector<OptionInfo> options;
  std::vector<OptionInfo> positionals;
  std::vector<CommandInfo> commands;
};

/// Copies the declared commands and options, in the order of their declaration. [any]
CommandInfo command_info(const CLI::App& app);

/// Returns the file name extension that completes the option's value: "lua" for "SCENE.lua", "take" for "TAKE"; several
/// as "urdf|xml"; "*" for any file, "/" for a folder; empty if the value is not a file. [any]
std::string file_extension(const OptionInfo& option);

/// Returns limber(1) in the man macros of roff, with all commands on one page. [any]
std::string man_page(const CommandInfo& program);

/// Returns the same as a page of Markdown, docs/reference/command_line.md. [any]
std::string command_page(const CommandInfo& program);

/// Returns a bash script that completes `limber`. It depends on no other script. [any]
std::string bash_completion(const CommandInfo& program);

/// Returns a function for zsh's completion system, to be saved as `_limber` in `fpath`. [any]
std::string zsh_completion(const CommandInfo& program);

}  // namespace limber::app
