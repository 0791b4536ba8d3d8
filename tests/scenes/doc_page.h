// Reads a page of docs/ for tests: its code blocks and its lines.
#pragma once

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limber {

/// A block such as "```lua scripts/pushed.lua error" and its text; the text blocks after it are the expected output.
struct DocBlock {
  std::string language;  ///< lua, xml, console
  std::string file;      ///< File name of the block; for a console block the scene that it is connected to.
  std::string expected;  ///< Empty, "error" (the scene is rejected) or "fails" (a callback fails).
  std::string text;
  std::vector<std::string> output;
  int line = 0;
};

inline std::vector<std::string> lines_of_page(const std::string& page) {
  std::ifstream in(LIMBER_SOURCE_DIR "/" + page);
  EXPECT_TRUE(in.good()) << page;
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Appends a line of a block. A backslash at its end continues the line, because pages have at most 120 columns.
inline void append_line(std::string& text, const std::string& line) {
  if (line.ends_with(" \\")) {
    text += line.substr(0, line.size() - 1);
  } else if (text.ends_with(' ')) {
    text += line.substr(std::min(line.find_first_not_of(' '), line.size())) + "\n";
  } else {
    text += line + "\n";
  }
}

inline std::vector<DocBlock> blocks_of_page(const std::string& page) {
  std::vector<DocBlock> list;
  std::string* target = nullptr;
  int number = 0;
  for (const std::string& line : lines_of_page(page)) {
    number++;
    if (!line.starts_with("```")) {
      if (target != nullptr) append_line(*target, line);
      continue;
    }
    if (target != nullptr) {
      target = nullptr;
      continue;
    }
    const std::string where = page + ":" + std::to_string(number);
    std::istringstream info(line.substr(3));
    std::string language;
    info >> language;
    if (language == "text") {
      if (list.empty()) list.emplace_back();
      EXPECT_FALSE(list.back().language.empty()) << where << ": output without a block before it";
      target = &list.back().output.emplace_back();
      continue;
    }
    EXPECT_TRUE(language == "lua" || language == "xml" || language == "obj" || language == "console")
        << where << ": " << language;
    DocBlock& block = list.emplace_back();
    block.language = language;
    info >> block.file >> block.expected;
    block.line = number;
    EXPECT_FALSE(block.file.empty()) << where << ": a block needs a file name";
    target = &block.text;
  }
  EXPECT_EQ(target, nullptr) << page << ": the last block is not closed";
  return list;
}

}  // namespace limber
