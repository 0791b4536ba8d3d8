// Reads the commands and options that were declared with CLI11.
#include "app/cli/command_info.h"

#include <algorithm>
#include <string_view>

#include <CLI/CLI.hpp>

#include "base/text.h"

namespace limber::app {

namespace {

bool is_plain_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

void add_choices(std::vector<std::string>& choices, std::string_view text, char separator) {
  for (const std::string_view word : split(text, separator)) {
    if (is_plain_word(word) && std::ranges::find(choices, word) == choices.end()) choices.emplace_back(word);
  }
}

constexpr std::string_view kRange = ":from ";  // of between()

// CLI11 joins the name of a value and the descriptions of its checks by colons: "N:from 0.5 to 4",
// "SHELL:{bash,zsh}"
void read_value(OptionInfo& info, std::string text) {
  if (const std::size_t set = text.find(":{"); set != std::string::npos) {
    add_choices(info.choices, std::string_view(text).substr(set + 2, text.size() - set - 3), ',');
    text.resize(set);
  }
  if (const std::size_t range = text.find(kRange); range != std::string::npos) {
    info.range = text.substr(range + kRange.size());
    text.resize(range);
  }
  add_choices(info.choices, text, '|');
  info.value = std::move(text);
}

OptionInfo option_info(const CLI::Option& option) {
  OptionInfo info;
  for (const std::string& name : option.get_snames()) info.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) info.names.push_back("--" + name);
  info.about = option.get_description();
  info.required = option.get_required();
  if (option.get_items_expected_max() != 0) {
    read_value(info, option.get_type_name());
    if (info.value.empty()) info.value = option.get_single_name();
    // unlimited is a large number
    info.repeats = option.get_items_expected_max() > 1;
  }
  return info;
}

// Leaves out the footers of the commands around it, which commands without their own inherit.
CommandInfo read_command(const CLI::App& app, const std::vector<std::string>& inherited) {
  CommandInfo info;
  info.name = app.get_name();
  info.about = app.get_description();
  if (std::ranges::find(inherited, app.get_footer()) == inherited.end()) info.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options()) {
    (option->get_positional() ? info.positionals : info.options).push_back(option_info(*option));
  }
  std::vector<std::string> outer = inherited;
  outer.push_back(app.get_footer());
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    info.commands.push_back(read_command(*command, outer));
  }
  return info;
}

}  // namespace

CommandInfo command_info(const CLI::App& app) { return read_command(app, {}); }

std::string file_extension(const OptionInfo& option) {
  std::string extensions;
  for (const std::string_view word : split(option.value, '|')) {
    if (const std::size_t dot = word.rfind('.'); dot != std::string_view::npos && is_plain_word(word.substr(dot + 1)))
      extensions.append(extensions.empty() ? "" : "|").append(word.substr(dot + 1));
    if (word == "TAKE") return "take";
    if (word == "DIR" && extensions.empty()) return "/";
    if (word == "FILE") return "*";
  }
  return extensions;
}

}  // namespace limber::app
