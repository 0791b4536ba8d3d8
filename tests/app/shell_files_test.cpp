// The manual page and the completions contain each command and option of the help, and completion works in bash.
#include <algorithm>
#include <cctype>
#include <iterator>
#include <regex>
#include <sstream>

#include "app/program.h"

namespace limber::app::test {
namespace {

/// A command with the options listed in its help.
struct CommandHelp {
  std::string path;  ///< "limber take info"; "limber" for the program itself.
  std::vector<std::string> options;
};

/// Returns the option names at the start of a line of help: "  -e,--evaluate LUA   ...".
std::vector<std::string> option_names(const std::string& line) {
  static const std::regex name(R"(^[ ,]*(-[a-zA-Z]|--[a-z][a-z-]*)(?=[ ,]|$))");
  std::vector<std::string> names;
  std::smatch match;
  std::string rest = line;
  while (std::regex_search(rest, match, name)) {
    names.push_back(match[1]);
    rest = match.suffix();
  }
  return names;
}

/// Reads the help of a command and its subcommands.
void read_help(const std::vector<std::string>& words, std::vector<CommandHelp>& found) {
  std::vector<std::string> args = words;
  args.emplace_back("--help");
  std::istringstream help(run(args).out);
  CommandHelp command{"limber", {}};
  for (const std::string& word : words) command.path += " " + word;
  std::vector<std::string> inner;
  bool in_commands = false;
  for (std::string line; std::getline(help, line);) {
    std::string lower;
    for (const char c : line) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!line.starts_with(' ')) in_commands = lower == "subcommands:";
    if (in_commands && line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
      inner.push_back(line.substr(2, line.find(' ', 2) - 2));
    for (const std::string& name : option_names(line)) command.options.push_back(name);
  }
  found.push_back(command);
  for (const std::string& name : inner) {
    args = words;
    args.push_back(name);
    read_help(args, found);
  }
}

const std::vector<CommandHelp>& all_help() {
  static const std::vector<CommandHelp> all = [] {
    std::vector<CommandHelp> found;
    read_help({}, found);
    return found;
  }();
  return all;
}

std::string roff(const std::string& text) { return std::regex_replace(text, std::regex("-"), "\\-"); }

/// Returns the text from `mark` to the next line that begins with `end`.
std::string section(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t at = text.find(begin);
  if (at == std::string::npos) return {};
  return text.substr(at, text.find("\n" + end, at) - at);
}

TEST(ShellFiles, ReadsTheHelp) {
  EXPECT_GE(all_help().size(), 20U);
  EXPECT_EQ(all_help().front().options, (std::vector<std::string>{"-h", "--help", "--version"}));
}

TEST(ManPage, NamesEveryCommandAndOption) {
  const RunResult page = run({"man"});
  ASSERT_EQ(page.code, 0);
  for (const CommandHelp& command : all_help()) {
    const bool program = command.path == "limber";
    const std::string text =
        program ? section(page.out, ".SH OPTIONS", ".SH") : section(page.out, ".SS \\fB" + command.path + "\\fR", ".S");
    EXPECT_NE(text, "") << command.path;
    for (const std::string& option : command.options) {
      if (!program && (option == "-h" || option == "--help")) continue;
      EXPECT_NE(text.find("\\fB" + roff(option) + "\\fR"), std::string::npos) << command.path << " " << option;
    }
  }
}

TEST(ManPage, HasValuesTextsAndExamples) {
  const std::string page = run({"man"}).out;
  const std::string play = section(page, ".SS \\fBlimber play\\fR", ".S");
  EXPECT_NE(play.find(".TP\n\\fB\\-\\-fps\\fR \\fIN\\fR\n"), std::string::npos) << play;
  EXPECT_NE(play.find("(0.001 to 1000)\n"), std::string::npos) << play;
  EXPECT_NE(play.find("\\fB\\-\\-quality\\fR \\fIlow|medium|high\\fR\n"), std::string::npos) << play;
  EXPECT_NE(page.find(".SS \\fBlimber send\\fR [\\fIOPTIONS\\fR] \\fIADDRESS\\fR [\\fIARGS\\fR ...]\n"),
            std::string::npos);
  EXPECT_NE(page.find(".TP\n\\fBlimber console \\-e \\(aqsim.time\\(aq\\fR\n"), std::string::npos);
  EXPECT_NE(page.find("limber 0."), std::string::npos) << "the version is in the title";
}

TEST(ManPage, NoTextIsAMacro) {
  // a line that begins with a period or an apostrophe is a request: only requests used by the page may occur
  std::istringstream page(run({"man"}).out);
  const std::regex known(R"(\.(\\"|TH|SH|SS|TP|PP|B|I|BR|IR|br|ad|nh)( .*)?)");
  for (std::string line; std::getline(page, line);) {
    EXPECT_FALSE(line.starts_with('\'')) << line;
    EXPECT_TRUE(!line.starts_with('.') || std::regex_match(line, known)) << line;
  }
}

/// Returns the words that bash offers for a command line; the cursor is at the last word.
std::string offered(const TempFolder& folder, const std::string& line) {
  folder.file("limber.bash", run({"completion", "bash"}).out);
  const RunResult result =
      Process({"bash", "--norc", "-c",
               ". ./limber.bash && COMP_WORDS=(" + line +
                   ") && COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) && _limber && echo \"${COMPREPLY[*]}\""},
              folder.path())
          .finish();
  EXPECT_EQ(result.code, 0) << line << ": " << result.err;
  EXPECT_EQ(result.err, "") << line;
  return result.out.substr(0, result.out.find('\n'));
}

TEST(BashCompletion, OffersEveryOptionOfEachCommand) {
  const TempFolder folder;
  for (const CommandHelp& command : all_help()) {
    const std::string words = " " + offered(folder, command.path + " -") + " ";
    for (const std::string& option : command.options)
      EXPECT_NE(words.find(" " + option + " "), std::string::npos) << command.path << " " << option << ":" << words;
  }
}

// bash sorts completions itself
std::vector<std::string> sorted_words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
  std::sort(words.begin(), words.end());
  return words;
}

struct Offer {
  const char* line;
  const char* words;
};

TEST(BashCompletion, OffersMatchingWords) {
  const TempFolder folder;
  for (const char* name :
       {"show/a.lua", "show/b.lua", "show/c.take", "show/d.urdf", "show/e.json", "show/f.txt", "show/g.xml"})
    folder.file(name, "");
  for (const Offer& offer : {Offer{"limber pl", "play"},
                             {"limber preset ''", "import"},
                             {"limber new s", "show scene"},
                             {"limber --fas", "--fast"},
                             {"limber --vers", "--version"},
                             {"limber show/", "show/a.lua show/b.lua show/d.urdf show/g.xml"},
                             {"limber play show/", "show/a.lua show/b.lua show/d.urdf show/g.xml"},
                             {"limber --fast show/", "show/a.lua show/b.lua show/d.urdf show/g.xml"},
                             {"limber --seed 3 show/", "show/a.lua show/b.lua show/d.urdf show/g.xml"},
                             {"limber show/a.lua --dur", "--duration"},
                             {"limber show/a.lua show/", ""},
                             {"limber --replay show/", "show/c.take"},
                             {"limber take info show/", "show/c.take"},
                             {"limber inspect show/", "show/d.urdf show/g.xml"},
                             {"limber preset import show/", "show/e.json"},
                             {"limber preset import show/e.json show/", "show/a.lua show/b.lua"},
                             {"limber --package-path sh", "show"},
                             {"limber play --quality ''", "low medium high"},
                             {"limber play --quality = m", "medium"},
                             {"limber play --quality =", "low medium high"},
                             {"limber --osc-in ''", "off"},
                             {"limber --set ''", ""},
                             {"limber export --format g", "gltf"},
                             {"limber bench --j", "--json"},
                             {"limber completion ''", "bash zsh"}}) {
    EXPECT_EQ(sorted_words(offered(folder, offer.line)), sorted_words(offer.words)) << offer.line;
  }
}

// Parentheses at the end of a pattern are qualifiers unless they contain alternatives.
TEST(ZshCompletion, PatternsOfFilesHaveNoQualifiers) {
  const std::string text = run({"completion", "zsh"}).out;
  EXPECT_NE(text.find(R"x('1:TAKE:_files -g "*.take"')x"), std::string::npos);
  EXPECT_NE(text.find(R"x(_files -g "*.(urdf|xml)"')x"), std::string::npos);
  EXPECT_FALSE(std::regex_search(text, std::regex(R"x(\([a-z]+\)"')x"))) << text;
}

TEST(ZshCompletion, HasEveryCommandAndOption) {
  const std::string text = run({"completion", "zsh"}).out;
  EXPECT_TRUE(text.starts_with("#compdef limber\n")) << "zsh finds it by this line";
  for (const CommandHelp& command : all_help()) {
    std::string function = "_" + command.path;
    for (char& c : function) c = c == ' ' ? '_' : c;
    const std::string body = section(text, "\n" + function + "() {\n", "}\n");
    EXPECT_NE(body, "") << function;
    const bool inner = text.find("\n" + function + "_") != std::string::npos;
    for (const std::string& option : command.options) {
      if (inner) continue;  // it takes subcommands instead of options
      const std::regex listed("['{,(*]" + option + "[=\\[,}' )]");
      EXPECT_TRUE(std::regex_search(body, listed)) << function << " " << option << "\n" << body;
    }
  }
}

TEST(ShellFiles, RejectsAnUnknownShell) {
  const RunResult result = run({"completion", "fish"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("fish"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace limber::app::test
