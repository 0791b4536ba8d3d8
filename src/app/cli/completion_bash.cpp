// Completion for bash: tables of each command's words, and one function that parses the line.
#include <string_view>

#include <fmt/format.h>

#include "app/cli/command_info.h"

namespace limber::app {

namespace {

// the fixed part of the script; it calls the functions that bash_table() generates from the options
constexpr std::string_view kBashReader = R"bash(
# adds the files with this extension, or one of several (A|B, * any, / none), and folders
_limber_files() {
  local name extension
  local -a found
  mapfile -t found < <(
    compgen -d -- "$cur"
    case $1 in
      /) ;;
      '*') compgen -f -- "$cur" ;;
      *) for extension in ${1//|/ }; do compgen -f -X "!*.$extension" -- "$cur"; done ;;
    esac
  )
  [ ${#found[@]} = 0 ] || compopt -o filenames 2>/dev/null
  for name in "${found[@]}"; do COMPREPLY+=("$name"); done
}

# adds the answers of a table: file:EXTENSION, or words
_limber_add() {
  local entry
  local -a words
  for entry; do
    case $entry in
      file:*) _limber_files "${entry#file:}" ;;
      *) mapfile -t words < <(compgen -W "$entry" -- "$cur"); COMPREPLY+=("${words[@]}") ;;
    esac
  done
}

_limber() {
  local cur=${COMP_WORDS[COMP_CWORD]} word option='' i=1 command=limber arguments=0
  local -a answers more
  COMPREPLY=()
  # bash splits --option=value into three words
  [ "$cur" != = ] || cur=''
  while [ "$i" -lt "$COMP_CWORD" ]; do
    word=${COMP_WORDS[i]}
    i=$((i + 1))
    [ "$word" != = ] || continue
    if [ -n "$option" ]; then option=''; continue; fi
    if [ "$arguments" = 0 ] && [[ " $(_limber_commands "$command") " == *" $word "* ]]; then
      command+=" $word"
      continue
    fi
    # a scene or an option in front means play
    [ "$command" != limber ] || command='limber play'
    if [[ " $(_limber_valued "$command") " == *" $word "* ]]; then
      option=$word
    elif [[ $word != -* ]]; then
      arguments=$((arguments + 1))
    fi
  done
  if [ -n "$option" ]; then
    mapfile -t answers < <(_limber_value "$command $option")
  elif [[ $cur == -* ]]; then
    answers=("$(_limber_options "$command")")
    [ "$command" != limber ] || answers+=("$(_limber_options 'limber play')")
  else
    [ "$arguments" != 0 ] || answers=("$(_limber_commands "$command")")
    [ "$command" != limber ] || command='limber play'
    mapfile -t more < <(_limber_argument "$command" "$arguments")
    answers+=("${more[@]}")
  fi
  _limber_add "${answers[@]}"
}
complete -F _limber limber
)bash";

// the completions of a value as table entries; empty: none
std::string bash_completions(const OptionInfo& option) {
  std::string text;
  if (!option.choices.empty()) {
    std::string words;
    for (const std::string& word : option.choices) words += (words.empty() ? "" : " ") + word;
    text += fmt::format(" '{}'", words);
  }
  if (const std::string extension = file_extension(option); !extension.empty())
    text += fmt::format(" 'file:{}'", extension);
  return text;
}

struct BashTables {
  std::string commands, valued, options, values, arguments;
};

void append_word(std::string& list, std::string_view separator, const std::string& word) {
  if (!list.empty()) list += separator;
  list += word;
}

void add_to_tables(BashTables& tables, const CommandInfo& command, const std::string& path) {
  std::string inner, valued, options;
  for (const CommandInfo& one : command.commands) append_word(inner, " ", one.name);
  for (const OptionInfo& option : command.options) {
    std::string patterns;
    for (const std::string& name : option.names) {
      append_word(options, " ", name);
      if (!option.value.empty()) append_word(valued, " ", name);
      append_word(patterns, " | ", fmt::format("'{} {}'", path, name));
    }
    if (const std::string completions = bash_completions(option); !completions.empty())
      tables.values += fmt::format("    {}) printf '%s\\n'{} ;;\n", patterns, completions);
  }
  int position = 0;
  for (const OptionInfo& argument : command.positionals) {
    const std::string completions = bash_completions(argument);
    if (!completions.empty())
      tables.arguments += fmt::format("    '{} {} printf '%s\\n'{} ;;\n", path,
                                      argument.repeats ? "'*)" : fmt::format("{}')", position), completions);
    ++position;
  }
  if (!inner.empty()) tables.commands += fmt::format("    '{}') echo '{}' ;;\n", path, inner);
  if (!valued.empty()) tables.valued += fmt::format("    '{}') echo '{}' ;;\n", path, valued);
  tables.options += fmt::format("    '{}') echo '{}' ;;\n", path, options);
  for (const CommandInfo& one : command.commands) add_to_tables(tables, one, path + " " + one.name);
}

std::string bash_table(std::string_view comment, std::string_view name, std::string_view subject,
                       std::string_view cases) {
  return fmt::format("\n# {}\n{}() {{\n  case {} in\n{}  esac\n}}\n", comment, name, subject, cases);
}

}  // namespace

std::string bash_completion(const CommandInfo& program) {
  BashTables tables;
  add_to_tables(tables, program, program.name);
  return "# shellcheck shell=bash\n# bash completion of limber(1), made by `limber completion bash`\n" +
         bash_table("commands within a command", "_limber_commands", "$1", tables.commands) +
         bash_table("options that take a value", "_limber_valued", "$1", tables.valued) +
         bash_table("options of a command", "_limber_options", "$1", tables.options) +
         bash_table("values of an option", "_limber_value", "$1", tables.values) +
         bash_table("arguments of a command: its path, how many are there already", "_limber_argument", "\"$1 $2\"",
                    tables.arguments) +
         std::string(kBashReader);
}

}  // namespace limber::app
