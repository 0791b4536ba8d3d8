// Writes roff. Help texts are plain text: a line that begins with two spaces is an example, "command   explanation".
#include "app/cli/command_info.h"

#include <span>
#include <string_view>

#include <fmt/format.h>

#include "app/cli/manual_sections.h"
#include "base/build_info.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr std::string_view kSeeAlso = R"(.SH SEE ALSO
.BR oscsend (1),
.BR oscdump (1)
.PP
The documentation is in
.IR /usr/share/doc/limber ;
.B limber docs
shows it in a browser.
)";

// escapes the characters that have a meaning in roff
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\'') {
      out += "\\(aq";
    } else {
      out += c;
    }
  }
  // a period at the start would be a macro
  return out.starts_with('.') ? "\\&" + out : out;
}

// position of the two spaces after the example's command
std::size_t end_of_command(std::string_view line) { return line.find("  "); }

void add_roff_example(std::string& page, std::string_view line) {
  line.remove_prefix(line.find_first_not_of(' '));
  const std::size_t end = end_of_command(line);
  page += fmt::format(".TP\n\\fB{}\\fR\n", roff(line.substr(0, end)));
  if (end != std::string_view::npos) {
    page += roff(line.substr(line.find_first_not_of(' ', end))) + "\n";
  } else {
    page += "\\&\n";
  }
}

void add_roff_text(std::string& page, std::string_view text) {
  bool in_paragraph = false;
  for (const std::string_view line : split(text, '\n')) {
    if (line.starts_with("  ")) {
      add_roff_example(page, line);
      in_paragraph = false;
    } else if (line.empty()) {
      in_paragraph = false;
    } else {
      if (!in_paragraph) page += ".PP\n";
      page += roff(line) + "\n";
      in_paragraph = true;
    }
  }
}

std::string roff_names(const OptionInfo& option) {
  std::string text;
  for (const std::string& name : option.names)
    text += fmt::format("{}\\fB{}\\fR", text.empty() ? "" : ", ", roff(name));
  if (option.value.empty()) return text;
  return text + fmt::format("{}\\fI{}\\fR", text.empty() ? "" : " ", roff(option.value));
}

void add_roff_option(std::string& page, const OptionInfo& option) {
  page += fmt::format(".TP\n{}\n{}", roff_names(option), roff(option.about));
  if (!option.range.empty()) page += fmt::format(" ({})", roff(option.range));
  if (!option.choices.empty() && option.value.find('|') == std::string::npos) {
    std::string list;
    for (const std::string& word : option.choices) list += (list.empty() ? "" : ", ") + roff(word);
    page += fmt::format(" ({})", list);
  }
  page += option.about.empty() ? "\\&\n" : "\n";
}

std::string roff_synopsis(const CommandInfo& command, const std::string& path) {
  std::string text = fmt::format("\\fB{}\\fR", roff(path));
  if (!command.commands.empty()) text += " \\fICOMMAND\\fR";
  if (command.options.size() > 1) text += " [\\fIOPTIONS\\fR]";
  for (const OptionInfo& argument : command.positionals) {
    const std::string name = fmt::format("\\fI{}\\fR{}", roff(argument.value), argument.repeats ? " ..." : "");
    text += argument.required ? " " + name : " [" + name + "]";
  }
  return text;
}

void add_roff_command(std::string& page, const CommandInfo& command, const std::string& path) {
  page += fmt::format(".SS {}\n{}\n", roff_synopsis(command, path), roff(command.about));
  for (const OptionInfo& argument : command.positionals) add_roff_option(page, argument);
  for (const OptionInfo& option : command.options) {
    if (option.names.back() != "--help") add_roff_option(page, option);
  }
  add_roff_text(page, command.footer);
  for (const CommandInfo& inner : command.commands) add_roff_command(page, inner, path + " " + inner.name);
}

void add_roff_entries(std::string& page, std::string_view title, std::span<const ManualEntry> entries) {
  page += fmt::format(".SH {}\n", title);
  for (const ManualEntry& entry : entries)
    page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(entry.term), roff(entry.text));
}

}  // namespace

std::string man_page(const CommandInfo& program) {
  std::string page = fmt::format(
      ".\\\" Made by `limber man`.\n.TH LIMBER 1 \"\" \"limber {}\" \"User Commands\"\n.ad l\n.nh\n", roff(version()));
  page += ".SH NAME\nlimber \\- live simulator of actuated, articulated bodies\n.SH SYNOPSIS\n";
  page += ".B limber\n[\\fISCENE.lua\\fR] [\\fIOPTIONS\\fR]\n.br\n.B limber\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  page += ".SH DESCRIPTION\n";
  add_roff_text(page, program.about);
  page += ".SH OPTIONS\n";
  for (const OptionInfo& option : program.options) add_roff_option(page, option);
  page += ".SH COMMANDS\nWithout a command,\n.B limber\nplays.\n";
  for (const CommandInfo& command : program.commands) add_roff_command(page, command, "limber " + command.name);
  add_roff_entries(page, "EXIT STATUS", manual_exit_codes());
  add_roff_entries(page, "FILES", manual_files());
  add_roff_entries(page, "ENVIRONMENT", manual_environment());
  page += kSeeAlso;
  return page;
}

}  // namespace limber::app
