// Every file says what it is and stays short, and the map in src/README.md names every room.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "architecture/source_rules.h"

namespace limber::rules {
namespace {

TEST(Files, OpenWithACommentAndStayShort) {
  std::size_t seen = 0;
  for (const char* folder : {"src", "tests", "scripts", "behaviors_lua"}) {
    for (const SourceFile& file : source_files(folder, {".h", ".hpp", ".cpp", ".inc", ".lua", ".cmake"})) {
      if (file.path.starts_with("scripts/library/")) continue;  // made by the program
      for (const std::string& complaint : shape_complaints(file.path, file.text)) ADD_FAILURE() << complaint;
      ++seen;
    }
  }
  EXPECT_GT(seen, 10U) << "the tree was not found";
}

TEST(Files, PlantedFaultsAreFound) {
  EXPECT_EQ(shape_complaints("src/sim/a.cpp", "#include <cmath>\n"),
            std::vector<std::string>{"src/sim/a.cpp: does not open with a comment that says what it is"});
  EXPECT_EQ(shape_complaints("scripts/a.lua", "// not Lua\n").size(), 1U);
  EXPECT_TRUE(shape_complaints("scripts/a.lua", "-- What it is.\n").empty());

  std::string text = "// What it is.\n";
  for (int line = 1; line < 500; ++line) text += "int x;\n";
  EXPECT_TRUE(shape_complaints("src/sim/a.cpp", text).empty());
  EXPECT_EQ(shape_complaints("src/sim/a.cpp", text + "\n"),
            std::vector<std::string>{"src/sim/a.cpp: has 501 lines, 500 are allowed"});
}

TEST(Files, MathIsTheSameOnEveryMachine) {
  for (const SourceFile& file : source_files("src", {".h", ".cpp"})) {
    for (const std::string& complaint : math_complaints(file.path, file.text)) ADD_FAILURE() << complaint;
  }
  EXPECT_EQ(math_complaints("src/sim/a.cpp", "x = std::sin(y) + glm::slerp(a, b, 1);").size(), 2U);
  EXPECT_TRUE(math_complaints("src/sim/a.cpp", "x = fixed::sin(std::sqrt(y)) + std::exchange(a, b);").empty());
  EXPECT_TRUE(math_complaints("src/view/a.cpp", "x = std::sin(y);").empty());
}

TEST(Files, TextIsWrittenByOneModule) {
  for (const SourceFile& file : source_files("src", {".h", ".cpp"})) {
    for (const std::string& complaint : output_complaints(file.path, file.text)) ADD_FAILURE() << complaint;
  }
  for (const char* line :
       {"fmt::print(stderr, \"x\");", "std::cerr << 1;", "std::fputs(\"x\", stderr);", "printf(text);"})
    EXPECT_EQ(output_complaints("src/app/a.cpp", line).size(), 1U) << line;
  for (const char* line :
       {"print_notice(\"to stderr\");", "// not std::cout", "std::snprintf(a, 4, b);", "log_to_stderr(1);"})
    EXPECT_TRUE(output_complaints("src/app/a.cpp", line).empty()) << line;
}

TEST(Files, TheMapNamesEveryRoom) {
  std::ifstream in(LIMBER_SOURCE_DIR "/src/README.md");
  const std::string map{std::istreambuf_iterator<char>(in), {}};
  ASSERT_FALSE(map.empty()) << "src/README.md is missing";
  for (const auto& entry : std::filesystem::directory_iterator(LIMBER_SOURCE_DIR "/src")) {
    if (!entry.is_directory() || std::filesystem::is_empty(entry.path())) continue;
    const std::string name = entry.path().filename().string();
    EXPECT_NE(map.find("`" + name + "/`"), std::string::npos) << "src/README.md does not name `" << name << "/`";
  }
}

}  // namespace
}  // namespace limber::rules
