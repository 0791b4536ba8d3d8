// docs/plots: the pictures of docs/behaviors.md are those that the program draws today.
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.h"
#include "doc_page.h"
#include "sim/behavior_type.h"

namespace limber {
namespace {

using app_test::Ran;

/// What stands between the numbers of a picture, and these.
struct Picture {
  std::string words;
  std::vector<double> numbers;
};

Picture read_picture(const std::string& svg) {
  Picture picture;
  const auto digit = [&](std::size_t i) {
    return i < svg.size() && std::isdigit(static_cast<unsigned char>(svg[i])) != 0;
  };
  for (std::size_t i = 0; i < svg.size();) {
    const bool negative = svg[i] == '-' && digit(i + 1);
    // digits behind a letter or in a colour belong to a word
    const bool in_word = i > 0 && (svg[i - 1] == '#' || svg[i - 1] == '_' ||
                                   (std::isalnum(static_cast<unsigned char>(svg[i - 1])) != 0 &&
                                    std::string_view("MVH").find(svg[i - 1]) == std::string_view::npos));
    if (in_word || !(digit(i) || negative)) {
      picture.words += svg[i++];
      continue;
    }
    char* end = nullptr;
    picture.numbers.push_back(std::strtod(svg.c_str() + i, &end));
    picture.words += '0';
    i = static_cast<std::size_t>(end - svg.c_str());
  }
  return picture;
}

// as docs/plots/make takes them apart: "<!-- name.svg -->", then the picture
std::map<std::string, std::string> drawn() {
  const Ran ran = app_test::run({"docs/plots/behaviors.lua", "--fast", "--ticks", "200", "--strict"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  std::map<std::string, std::string> pictures;
  std::string* into = nullptr;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("<!-- ")) {
      into = &pictures[line.substr(5, line.size() - 9)];
    } else if (into != nullptr) {
      *into += line + "\n";
    }
  }
  return pictures;
}

TEST(Plots, AreTodays) {
  const std::map<std::string, std::string> pictures = drawn();
  EXPECT_EQ(pictures.size(), 12u);
  for (const auto& [name, svg] : pictures) {
    SCOPED_TRACE("docs/plots/" + name + "; docs/plots/make draws it anew");
    const Picture now = read_picture(svg);
    const Picture committed = read_picture(app_test::content(LIMBER_SOURCE_DIR "/docs/plots/" + name));
    EXPECT_EQ(now.words, committed.words);
    ASSERT_EQ(now.numbers.size(), committed.numbers.size());
    ASSERT_GT(now.numbers.size(), 100u);
    double farthest = 0;
    for (std::size_t i = 0; i < now.numbers.size(); i++) {
      farthest = std::max(farthest, std::abs(now.numbers[i] - committed.numbers[i]));
    }
    EXPECT_LE(farthest, 0.5) << "pixels; another machine's arithmetic is far below that";
  }
}

TEST(Plots, EveryBuiltInTypeHasOneAndItIsOnThePage) {
  std::string page;
  for (const std::string& line : lines_of_page("docs/behaviors.md")) page += line + "\n";
  const BehaviorTypes built_in;
  for (const auto& type : built_in.all()) {
    EXPECT_FALSE(app_test::content(LIMBER_SOURCE_DIR "/docs/plots/" + type->name + ".svg").empty()) << type->name;
    EXPECT_NE(page.find("![" + type->name + "](plots/" + type->name + ".svg)"), std::string::npos) << type->name;
  }
}

// a curve that is off by half a grid line must be seen
TEST(Plots, TheReaderSeesNumbersWhereTheyAre) {
  const Picture picture = read_picture("<path d=\"M62.0 -3V16.5\" stroke=\"#5f3dc4\"/>x1 12,5.5");
  EXPECT_EQ(picture.numbers, (std::vector<double>{62, -3, 16.5, 12, 5.5}));
  EXPECT_EQ(picture.words, "<path d=\"M0 0V0\" stroke=\"#5f3dc4\"/>x1 0,0");
}

}  // namespace
}  // namespace limber
