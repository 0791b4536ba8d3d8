// docs/howto/from-ofxDabPhysics.md: every Limber name in its tables exists, and every message of ofxDabPhysics is
// listed.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "app/commands/describe.h"
#include "app/program.h"
#include "base/text.h"
#include "engine/seed_table.h"
#include "script/luacats.h"
#include "sim/behavior/behavior_type.h"

namespace limber::app::test {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (const std::string_view cell : split(line, '|')) {
    const std::size_t begin = std::min(cell.find_first_not_of(' '), cell.size());
    cells.emplace_back(cell.substr(begin, cell.find_last_not_of(' ') + 1 - begin));
  }
  // before the first bar and after the last are no cells
  cells.erase(cells.begin());
  cells.pop_back();
  return cells;
}

// the texts between backticks
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  std::size_t at = text.find('`');
  while (at != std::string::npos) {
    const std::size_t end = text.find('`', at + 1);
    if (end == std::string::npos) break;
    names.push_back(text.substr(at + 1, end - at - 1));
    at = text.find('`', end + 1);
  }
  return names;
}

struct LegacyPage : testing::Test {
  LegacyPage() {
    std::ifstream in(LIMBER_SOURCE_DIR "/docs/howto/from-ofxDabPhysics.md");
    std::string section;
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("## ")) section = line.substr(3);
      if (!line.starts_with("| `") && !line.starts_with("| all ")) continue;
      entries.emplace_back(section, cells_of(line));
    }
  }
  std::vector<std::vector<std::string>> in(const std::string& section) const {
    std::vector<std::vector<std::string>> found;
    for (const auto& [of, cells] : entries) {
      if (of == section) found.push_back(cells);
    }
    EXPECT_FALSE(found.empty()) << section;
    return found;
  }
  std::vector<std::pair<std::string, std::vector<std::string>>> entries;
};

// "body:copy", "sim.gravity", "visuals.camera", "sim"
bool exists(const script::luacats::Reader& lua, std::string name) {
  if (name.starts_with("rgb(")) name = "rgb";
  const std::size_t separator = name.find_first_of(".:");
  std::string owner = name.substr(0, separator);
  if (owner == "group") owner = "behavior_group";
  if (separator == std::string::npos) return lua.classes.contains(owner) || lua.functions.contains(owner);
  const auto found = lua.classes.find(owner);
  if (found == lua.classes.end()) return false;
  const std::string member = name.substr(separator + 1);
  return name[separator] == ':' ? found->second.functions.contains(member) : found->second.fields.contains(member);
}

TEST_F(LegacyPage, LuaNamesExist) {
  const RunResult result = run({"annotate"});
  ASSERT_EQ(result.code, 0);
  const script::luacats::Reader lua{result.out};
  for (const char* section : {"Classes", "Messages in"}) {
    for (const auto& cells : in(section)) {
      ASSERT_EQ(cells.size(), 3u) << cells[0];
      for (const std::string& name : names_in(cells[1])) EXPECT_TRUE(exists(lua, name)) << name;
    }
  }
  // in remarks check only names written as members
  for (const auto& cells : in("Classes")) {
    for (const std::string& name : names_in(cells[2])) {
      const bool member = name.find_first_of(".:") != std::string::npos && name.find(' ') == std::string::npos;
      EXPECT_TRUE(!member || exists(lua, name)) << name;
    }
  }
}

TEST_F(LegacyPage, ListsEveryLegacyMessage) {
  std::set<std::string> listed;
  for (const auto& cells : in("Messages in")) listed.insert(names_in(cells[0]).at(0));
  std::set<std::string> seeds;
  for (const auto& a : engine::test::kElementAddresses) seeds.insert(engine::test::legacy_address(a));
  for (const auto& a : engine::test::kShapeAddresses) seeds.insert(engine::test::legacy_address(a));
  seeds.insert(std::begin(engine::test::kSingletonAddresses), std::end(engine::test::kSingletonAddresses));
  seeds.insert(std::begin(engine::test::kOtherAddresses), std::end(engine::test::kOtherAddresses));
  EXPECT_EQ(seeds.size(), 52u);
  EXPECT_EQ(listed, seeds);
  std::set<std::string> out;
  for (const auto& cells : in("Messages out")) out.insert(names_in(cells[0]).at(0));
  EXPECT_EQ(out, (std::set<std::string>{"/physics/joint/pos", "/physics/joint/rot", "/physics/joint/relrot"}));
}

TEST_F(LegacyPage, BehaviorsHaveTheirParameters) {
  const sim::BehaviorTypes types;
  std::set<std::string> listed;
  for (const auto& cells : in("Behaviors")) {
    ASSERT_EQ(cells.size(), 3u);
    if (cells[0] == "all") continue;
    const std::string theirs = names_in(cells[0]).at(0);
    const std::string ours = names_in(cells[1]).at(0);
    const auto type = types.find(ours);
    ASSERT_NE(type, nullptr) << ours;
    EXPECT_EQ(types.find(theirs), type) << theirs << " is also found by its legacy name";
    for (const std::string& name : names_in(cells[2]))
      EXPECT_NE(type->table->find(name), nullptr) << ours << " " << name;
    listed.insert(ours);
  }
  for (const auto& type : types.all()) {
    const bool is_new = type->name == "separation" || type->name.starts_with("mocap_");
    EXPECT_TRUE(listed.contains(type->name) || is_new) << type->name;
  }
}

}  // namespace
}  // namespace limber::app::test
