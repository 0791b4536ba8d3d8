// docs/plots: the plots in docs/reference/behaviors.md are equal to those that the program draws.
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.h"
#include "doc_page.h"
#include "sim/behavior/behavior_type.h"
#include "support/skip.h"

namespace limber {
namespace {

using app::test::RunResult;

/// An SVG file split into its numbers and the text between them, in which each number is replaced by 0.
struct Plot {
  std::string words;
  std::vector<double> numbers;
};

Plot read_plot(const std::string& svg) {
  Plot plot;
  const auto digit = [&](std::size_t i) {
    return i < svg.size() && std::isdigit(static_cast<unsigned char>(svg[i])) != 0;
  };
  for (std::size_t i = 0; i < svg.size();) {
    const bool negative = svg[i] == '-' && digit(i + 1);
    // digits after a letter or in a color belong to a word
    const bool in_word = i > 0 && (svg[i - 1] == '#' || svg[i - 1] == '_' ||
                                   (std::isalnum(static_cast<unsigned char>(svg[i - 1])) != 0 &&
                                    std::string_view("MVH").find(svg[i - 1]) == std::string_view::npos));
    if (in_word || !(digit(i) || negative)) {
      plot.words += svg[i++];
      continue;
    }
    char* end = nullptr;
    plot.numbers.push_back(std::strtod(svg.c_str() + i, &end));
    plot.words += '0';
    i = static_cast<std::size_t>(end - svg.c_str());
  }
  return plot;
}

// Draws all plots. Returns SVG texts by file name; the output has a line "<!-- name.svg -->" before each plot.
std::map<std::string, std::string> draw_plots() {
  const auto result = app::test::run({"docs/plots/behaviors.lua", "--fast", "--ticks", "200", "--strict"});
  EXPECT_EQ(result.code, 0) << result.err;
  std::map<std::string, std::string> plots;
  std::string* plot = nullptr;
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("<!-- ")) {
      plot = &plots[line.substr(5, line.size() - 9)];
    } else if (plot != nullptr) {
      *plot += line + "\n";
    }
  }
  return plots;
}

TEST(Plots, AreUpToDate) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  const std::map<std::string, std::string> plots = draw_plots();
  EXPECT_EQ(plots.size(), sim::BehaviorTypes().all().size());
  for (const auto& [name, svg] : plots) {
    SCOPED_TRACE("docs/plots/" + name + "; docs/plots/make updates it");
    const Plot now = read_plot(svg);
    const Plot committed = read_plot(app::test::content(LIMBER_SOURCE_DIR "/docs/plots/" + name));
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

TEST(Plots, EveryBuiltInTypeHasAPlotOnThePage) {
  std::string page;
  for (const std::string& line : lines_of_page("docs/reference/behaviors.md")) page += line + "\n";
  const sim::BehaviorTypes built_in;
  for (const auto& type : built_in.all()) {
    EXPECT_FALSE(app::test::content(LIMBER_SOURCE_DIR "/docs/plots/" + type->name + ".svg").empty()) << type->name;
    EXPECT_NE(page.find("![" + type->name + "](../plots/" + type->name + ".svg)"), std::string::npos) << type->name;
  }
}

TEST(Plots, TheParserFindsNumbers) {
  const Plot plot = read_plot("<path d=\"M62.0 -3V16.5\" stroke=\"#5f3dc4\"/>x1 12,5.5");
  EXPECT_EQ(plot.numbers, (std::vector<double>{62, -3, 16.5, 12, 5.5}));
  EXPECT_EQ(plot.words, "<path d=\"M0 0V0\" stroke=\"#5f3dc4\"/>x1 0,0");
}

}  // namespace
}  // namespace limber
