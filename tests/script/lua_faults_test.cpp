// Known faults of LuaJIT: each file of luajit_faults/ reproduces one in a plain Lua state, and not in a scene.
// docs/understand/luajit.md has a table row for each, with the affected releases and the protection.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/sanitized.h"
#include "base/text.h"
#include "lua_runs.h"
#include "stage.h"

namespace limber::script {
namespace {

using test::LuaRun;
using test::run_plainly;
using test::run_texts;

std::string content(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::map<std::string, std::string> fault_texts() {
  std::map<std::string, std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(LIMBER_SOURCE_DIR "/tests/script/luajit_faults"))
    texts[entry.path().stem().string()] = content(entry.path());
  return texts;
}

// The rows of the table: cells by the file name in the first cell.
std::map<std::string, std::vector<std::string>> table_rows() {
  std::map<std::string, std::vector<std::string>> rows;
  std::istringstream lines(content(LIMBER_SOURCE_DIR "/docs/understand/luajit.md"));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    for (const std::string_view cell : split(line, '|'))
      cells.emplace_back(cell.size() < 2 ? cell : cell.substr(1, cell.size() - 2));
    const std::string name = cells.at(1).substr(1, cells[1].size() - 2);
    rows[name] = {cells.begin() + 2, cells.end()};
  }
  return rows;
}

// Cells of a row after the name: the fault, the releases, the protection.
constexpr std::size_t kDebian12 = 1, kFork = 2, kDebian13 = 3, kProtection = 4;

bool is_protected(const std::vector<std::string>& cells) { return !cells.at(kProtection).starts_with("none"); }

// The table's column for the LuaJIT of this program.
std::optional<std::size_t> installed_column() {
  const std::string version = run_plainly("(...)(jit.arch, jit.version, (pcall(require, 'table.nkeys')))", {});
  if (version.starts_with("x64 LuaJIT 2.1.1737090214 ")) return kDebian13;
  if (version.starts_with("x64 LuaJIT 2.1.0-beta3 true")) return kFork;
  if (version.starts_with("x64 LuaJIT 2.1.0-beta3 ")) return kDebian12;
  return std::nullopt;
}

TEST(LuaFaults, TheTableListsEveryFault) {
  const auto table = table_rows();
  const auto texts = fault_texts();
  for (const auto& [name, text] : texts) EXPECT_TRUE(table.count(name) == 1) << name;
  for (const auto& [name, cells] : table) {
    EXPECT_TRUE(texts.count(name) == 1) << name;
    ASSERT_GT(cells.size(), kProtection) << name;
    for (const std::size_t cell : {kDebian12, kFork, kDebian13})
      EXPECT_TRUE(cells[cell] == "wrong" || cells[cell] == "crash" || cells[cell] == "no") << name;
  }
}

TEST(LuaFaults, ScenesAreNotAffected) {
  const auto table = table_rows();
  std::vector<std::string> names, texts;
  for (const auto& [name, text] : fault_texts()) {
    if (!is_protected(table.at(name))) continue;
    names.push_back(name);
    texts.push_back(text);
  }
  const auto expected = run_texts(texts, {false, 0});
  ASSERT_EQ(expected.size(), texts.size());
  for (const int hot_loop : {0, 1}) {
    if (kSanitized && hot_loop == 0) continue;  // they take too long there
    for (std::size_t i = 0; i < texts.size(); i++) {
      const auto result = run_texts({texts[i]}, {true, hot_loop});
      EXPECT_EQ(result.at(0), expected[i]) << names[i] << ", hot_loop " << hot_loop;
    }
  }
}

// Faults of the installed LuaJIT without protection. Other releases, and processors other than x64, have other faults;
// sanitizers report crashes themselves. A `crash` is an access to memory out of bounds: what lies there decides whether
// it crashes, gives wrong values, or has no effect.
TEST(LuaFaults, TheInstalledVersionHasTheFaultsOfItsColumn) {
  const std::optional<std::size_t> column = installed_column();
  if (kSanitized || !column) return;
  const auto table = table_rows();
  for (const auto& [name, text] : fault_texts()) {
    const std::string& known = table.at(name).at(*column);
    if (known == "crash") continue;
    const std::string expected = run_plainly(text, {false, 0});
    bool differs = expected.starts_with("crashed");
    for (const int hot_loop : {0, 1}) differs |= run_plainly(text, {true, hot_loop}) != expected;
    EXPECT_EQ(differs, known == "wrong") << name;
  }
}

}  // namespace
}  // namespace limber::script
