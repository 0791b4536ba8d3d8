// docs/scripting.md: every block of Lua on the page is played, every error shown is the one that is said.
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "player.h"

namespace limber {
namespace {

/// "```lua scripts/pushed.lua error" and what stands in it; the text block behind it is what is said.
struct Block {
  std::string file;
  std::string expected;  // nothing, error, fails
  std::string code;
  std::string said;
  int line = 0;
};

std::vector<Block> blocks() {
  std::ifstream page(LIMBER_SOURCE_DIR "/docs/scripting.md");
  std::vector<Block> list;
  std::string* into = nullptr;
  int number = 0;
  for (std::string line; std::getline(page, line);) {
    number++;
    if (!line.starts_with("```")) {
      if (into != nullptr) *into += line + "\n";
      continue;
    }
    if (into != nullptr) {
      into = nullptr;
      continue;
    }
    std::istringstream info(line.substr(3));
    std::string language;
    info >> language;
    if (language == "text") {
      EXPECT_FALSE(list.empty());
      into = &list.back().said;
      continue;
    }
    EXPECT_EQ(language, "lua") << "docs/scripting.md:" << number;
    Block& block = list.emplace_back();
    info >> block.file >> block.expected;
    block.line = number;
    EXPECT_FALSE(block.file.empty()) << "docs/scripting.md:" << number << ": a block of Lua says which file it is";
    into = &block.code;
  }
  return list;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// what was said by /script/error, first lines
std::vector<std::string> faults(Player& player) {
  std::vector<std::string> texts;
  for (const Message& message : player.sent()) {
    if (message.address == "/script/error") texts.push_back(first_line(message.args.at(2).text));
  }
  return texts;
}

TEST(ScriptingDoc, EveryBlockDoesWhatThePageSays) {
  const ShowFolder show;
  const std::vector<Block> all = blocks();
  ASSERT_GT(all.size(), 10u);
  int played = 0;
  // behaviours come before the scenes that name them, in whatever order the page tells of them
  for (const Block& block : all) show.write(block.file, block.code);
  for (const Block& block : all) {
    if (!block.file.starts_with("scripts/")) continue;
    SCOPED_TRACE("docs/scripting.md:" + std::to_string(block.line) + " " + block.file);
    Player player(show.write(block.file, block.code), Player::MayFail{});
    const std::string said = first_line(block.said);
    if (block.expected == "error") {
      ASSERT_FALSE(player.started.ok());
      EXPECT_EQ(first_line(player.started.error()), said);
      continue;
    }
    ASSERT_TRUE(player.started.ok()) << player.started.error();
    for (int i = 0; i < 120; i++) player.engine->tick();
    const std::vector<std::string> told = faults(player);
    if (block.expected == "fails") {
      EXPECT_EQ(told, std::vector<std::string>{said});
      EXPECT_EQ(player.world().tick(), 120u) << "the show plays on";
    } else {
      EXPECT_EQ(block.expected, "");
      EXPECT_EQ(told, std::vector<std::string>{});
      EXPECT_EQ(player.engine->faults(), 0u);
    }
    played++;
  }
  EXPECT_GE(played, 8);
}

// a block that nobody plays proves nothing
TEST(ScriptingDoc, EveryBehaviorOnThePageIsPlayed) {
  std::string scenes;
  for (const Block& block : blocks()) {
    if (block.file.starts_with("scripts/")) scenes += block.code;
  }
  for (const Block& block : blocks()) {
    if (!block.file.starts_with("behaviors_lua/")) continue;
    const std::string type = std::filesystem::path(block.file).stem().string();
    EXPECT_NE(scenes.find("\"" + type + "\""), std::string::npos) << type;
  }
}

}  // namespace
}  // namespace limber
