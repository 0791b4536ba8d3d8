// Completion for zsh: a function for each command that passes its options to _arguments.
#include <string_view>

#include <fmt/format.h>

#include "app/cli/command_info.h"

namespace limber::app {

namespace {

// escapes text for single quotes, and the special characters with a backslash
std::string zsh_escaped(std::string_view text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else if (c == '\n') {
      out += ' ';
    } else {
      if (c == '\\' || special.find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

std::string zsh_action(const OptionInfo& option) {
  const std::string extension = file_extension(option);
  if (!option.choices.empty()) {
    std::string words;
    for (const std::string& word : option.choices) words += (words.empty() ? "" : " ") + word;
    return fmt::format("({})", words);
  }
  if (extension == "/") return "_files -/";
  if (extension == "*") return "_files";
  if (extension.empty()) return " ";  // a space: the value has no completion
  // parentheses around one extension would be qualifiers of the pattern
  const bool several = extension.find('|') != std::string::npos;
  return fmt::format("_files -g \"*.{}\"", several ? fmt::format("({})", extension) : extension);
}

std::string zsh_value(const OptionInfo& option) {
  return option.value.empty() ? "" : fmt::format(":{}:{}", zsh_escaped(option.value, ":"), zsh_action(option));
}

// '(-h --help)'{-h,--help}'[text]', or '--fast[text]'
std::string zsh_option(const OptionInfo& option) {
  const std::string about = fmt::format("[{}]{}", zsh_escaped(option.about, "[]:"), zsh_value(option));
  std::string names;
  std::string braced;
  for (const std::string& name : option.names) {
    names += (names.empty() ? "" : " ") + name;
    braced += fmt::format("{}{}{}", braced.empty() ? "" : ",", name,
                          option.value.empty() || !name.starts_with("--") ? "" : "=");
  }
  if (option.names.size() > 1 && !option.repeats) return fmt::format("    '({})'{{{}}}'{}'", names, braced, about);
  if (option.names.size() > 1) return fmt::format("    '*'{{{}}}'{}'", braced, about);
  return fmt::format("    '{}{}{}'", option.repeats ? "*" : "", braced, about);
}

std::string zsh_argument(const OptionInfo& argument, int position) {
  // a second colon: the argument is optional
  return fmt::format("    '{}:{}{}:{}'", argument.repeats ? "*" : fmt::format("{}", position),
                     argument.required || argument.repeats ? "" : ":", zsh_escaped(argument.value, ":"),
                     zsh_action(argument));
}

std::string zsh_arguments(const CommandInfo& command) {
  std::string lines = "  _arguments -s -S";
  for (const OptionInfo& option : command.options) lines += " \\\n" + zsh_option(option);
  int position = 0;
  for (const OptionInfo& argument : command.positionals) lines += " \\\n" + zsh_argument(argument, ++position);
  return lines + "\n";
}

std::string zsh_function_name(const std::string& path) {
  std::string name = "_" + path;
  for (char& c : name) {
    if (c == ' ' || c == '-') c = '_';
  }
  return name;
}

// completes the name of a subcommand, or calls the function of the subcommand that is given
std::string zsh_choice(const CommandInfo& command, const std::string& path, std::string_view default_action) {
  std::string text = "  local -a commands=(\n";
  for (const CommandInfo& inner : command.commands)
    text += fmt::format("    '{}:{}'\n", inner.name, zsh_escaped(inner.about, ":"));
  text += "  )\n  if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then\n";
  text += "    _describe -t commands 'command' commands\n";
  if (!default_action.empty()) text += "    _files -g '*.lua'\n";
  text += "    return\n  fi\n  case $words[2] in\n";
  for (const CommandInfo& inner : command.commands)
    text += fmt::format("    {}) shift words; (( CURRENT-- )); {} ;;\n", inner.name,
                        zsh_function_name(path + " " + inner.name));
  return text +
         fmt::format("    *) {} ;;\n  esac\n", default_action.empty() ? "_message 'no such command'" : default_action);
}

void add_zsh_function(std::string& text, const CommandInfo& command, const std::string& path) {
  const bool outermost = path == command.name;
  text += fmt::format("\n{}() {{\n", zsh_function_name(path));
  if (command.commands.empty()) {
    text += zsh_arguments(command);
  } else if (outermost) {
    // without a command, `limber` plays
    text += zsh_choice(command, path, zsh_function_name(path + " play"));
  } else {
    text += zsh_choice(command, path, "");
  }
  text += "}\n";
  for (const CommandInfo& inner : command.commands) add_zsh_function(text, inner, path + " " + inner.name);
}

}  // namespace

std::string zsh_completion(const CommandInfo& program) {
  std::string text = "#compdef limber\n# zsh completion of limber(1), made by `limber completion zsh`\n";
  add_zsh_function(text, program, program.name);
  return text + "\n_limber \"$@\"\n";
}

}  // namespace limber::app
