// The generated pages of docs/reference: up to date, and complete for `limber describe` and the command line.
#include <algorithm>
#include <regex>
#include <sstream>

#include "app/commands/describe.h"
#include "app/program.h"

namespace limber::app::test {
namespace {

namespace fs = std::filesystem;

const fs::path kDocs = fs::path(LIMBER_SOURCE_DIR) / "docs";

TEST(CommandPage, CommittedPageIsUpToDate) {
  const RunResult page = run({"man", "--markdown"});
  ASSERT_EQ(page.code, 0) << page.err;
  EXPECT_EQ(content(kDocs / "reference/command_line.md"), page.out)
      << "update it: build/limber man --markdown > docs/reference/command_line.md";
}

// The names of commands in the list of subcommands of a help text.
std::vector<std::string> listed_commands(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help.substr(std::min(help.find("ubcommands:"), help.size())));
  static const std::regex command(R"(^  ([a-z]+) )");
  std::smatch match;
  for (std::string line; std::getline(lines, line) && !line.empty();) {
    if (std::regex_search(line, match, command)) names.push_back(match[1]);
  }
  return names;
}

TEST(CommandPage, HasEveryCommandOptionAndExitCode) {
  const std::string page = run({"man", "--markdown"}).out;
  const std::vector<std::string> commands = listed_commands(run({"--help"}).out);
  ASSERT_GE(commands.size(), 17u);
  for (const std::string& name : commands) {
    const std::size_t begin = page.find("\n## `limber " + name + "`\n");
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string section = page.substr(begin, page.find("\n## ", begin + 4) - begin);
    const std::string help = run({name, "--help"}).out;
    static const std::regex option("(--[a-z][a-z-]*)(?=[ ,\n])");
    for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
      const std::string word = (*it)[1];
      if (word != "--help") {
        EXPECT_NE(section.find(word), std::string::npos) << name << " " << word;
      }
    }
    const std::string example = name == "play" ? "\n    limber my.lua --" : "\n    limber " + name + " ";
    const std::string synopsis_end = section.substr(section.find("\n\n    limber ") + 10);
    EXPECT_TRUE(synopsis_end.find(example) != std::string::npos || name == "man" || name == "completion") << name;
    for (const std::string& inner : listed_commands(help))
      EXPECT_NE(section.find("\n### `limber " + name + " " + inner + "`\n"), std::string::npos) << name << " " << inner;
  }
  for (const char* code : {"- `0`: ", "- `1`: ", "- `2`: ", "- `3`: "}) EXPECT_NE(page.find(code), std::string::npos);
  EXPECT_NE(page.find("    limber export evening.take --format gltf"), std::string::npos) << "an example";
  EXPECT_NE(page.find("`--osc-in [ADDR:]PORT|off`: Address of OSC input; default 127.0.0.1:9003."), std::string::npos);
}

TEST(CommandPage, LinesHave120Columns) {
  std::istringstream lines(run({"man", "--markdown"}).out);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }), 120)
        << line;
  }
}

TEST(Annotate, WritesTheLuaReference) {
  const TempFolder folder;
  const RunResult written = run({"annotate", "--markdown", "a/lua"}, folder.path());
  EXPECT_EQ(written.code, 0) << written.err;
  EXPECT_EQ(written.out, "");
  int pages = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(folder.path()) / "a/lua")) {
    pages++;
    EXPECT_EQ(content(entry.path()), content(kDocs / "reference/lua" / entry.path().filename())) << entry.path();
  }
  EXPECT_GE(pages, 18);
  EXPECT_EQ(run({"annotate", "--markdown", "/proc/x"}, folder.path()).code, 3);
  EXPECT_EQ(run({"annotate", "--markdown", "a", "b.lua"}, folder.path()).code, 2) << "one or the other";
}

// Every property of `limber describe` is in the Lua reference or in the pages about OSC.
TEST(Reference, HasEveryNameOfDescribe) {
  std::string lua;
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(kDocs)) {
    if (entry.path().extension() != ".md") continue;
    const std::string path = entry.path().string();
    const bool reference = path.find("/reference/lua/") != std::string::npos;
    if (reference) lua += content(entry.path());
    if (reference || entry.path().filename().string().starts_with("osc")) all += content(entry.path());
  }
  for (const PropertyTable* table : described_classes()) {
    const bool for_scripts = table->path().starts_with("/physics/") || table->path().starts_with("/visuals");
    for (const Property& property : table->properties()) {
      const std::string name = fmt::format("{}`", property.name);
      const std::string& text = for_scripts ? lua : all;
      const bool found = text.find("`" + name) != std::string::npos || text.find("." + name) != std::string::npos ||
                         text.find(":" + name) != std::string::npos;
      EXPECT_TRUE(found) << table->path() << "/" << property.name;
    }
  }
  for (const engine::SpecialAddress& message : described_messages())
    EXPECT_NE(all.find(fmt::format("`{}`", message.address)), std::string::npos) << message.address;
}

}  // namespace
}  // namespace limber::app::test
