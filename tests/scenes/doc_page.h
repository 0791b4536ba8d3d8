// A page of docs/ as tests read it: its blocks between ```, and its lines.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limber {

/// "```lua scripts/pushed.lua error" and what stands in it; text blocks behind it are what is said.
struct DocBlock {
  std::string language;  ///< lua, xml, console
  std::string file;      ///< Which file it is; of a console the scene that it talks to.
  std::string expected;  ///< nothing, error, fails
  std::string text;
  std::vector<std::string> said;
  int line = 0;
};

inline std::vector<std::string> lines_of_page(const std::string& page) {
  std::ifstream in(LIMBER_SOURCE_DIR "/" + page);
  EXPECT_TRUE(in.good()) << page;
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::vector<DocBlock> blocks_of_page(const std::string& page) {
  std::vector<DocBlock> list;
  std::string* into = nullptr;
  int number = 0;
  for (const std::string& line : lines_of_page(page)) {
    number++;
    if (!line.starts_with("```")) {
      if (into != nullptr) *into += line + "\n";
      continue;
    }
    if (into != nullptr) {
      into = nullptr;
      continue;
    }
    const std::string where = page + ":" + std::to_string(number);
    std::istringstream info(line.substr(3));
    std::string language;
    info >> language;
    if (language == "text") {
      if (list.empty()) list.emplace_back();
      EXPECT_FALSE(list.back().language.empty()) << where << ": nothing before it could say that";
      into = &list.back().said.emplace_back();
      continue;
    }
    EXPECT_TRUE(language == "lua" || language == "xml" || language == "console") << where << ": " << language;
    DocBlock& block = list.emplace_back();
    block.language = language;
    info >> block.file >> block.expected;
    block.line = number;
    EXPECT_FALSE(block.file.empty()) << where << ": a block says which file it is";
    into = &block.text;
  }
  EXPECT_EQ(into, nullptr) << page << ": the last block is not closed";
  return list;
}

}  // namespace limber
