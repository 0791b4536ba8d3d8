// The command line as plain data: the source of the man page and of the completions for shells.
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): of CLI11
class App;
}

namespace limber {

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

/// Returns the file name extension that completes the option's value: "lua" for "SCENE.lua", "take" for "TAKE"; "*" for
/// any file, "/" for a folder; empty if the value is not a file. [any]
std::string file_extension(const OptionInfo& option);

}  // namespace limber
