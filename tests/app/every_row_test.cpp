// Sets every property with `--set`; the scene reads it back in its first callback.
#include <sstream>

#include <fmt/ranges.h>

#include "app/program.h"
#include "engine/every_row.h"
#include "engine/show.h"

namespace limber::app::test {
namespace {

using namespace engine::test;

std::string expected(const Property& property, const std::vector<double>& value) {
  if (property.type == PropertyType::choice) return property.choices[static_cast<std::size_t>(value[0])];
  std::string text;
  for (const double v : value) {
    if (!text.empty()) text += "\t";
    const bool flag = property.type == PropertyType::boolean || property.type == PropertyType::flags3;
    text += flag ? (v != 0 ? "true" : "false") : fmt::format("{:.14g}", v);
  }
  return text;
}

TEST(EveryProperty, CanBeSetOnTheCommandLine) {
  const SceneFile plain(kEverything);
  Show fixture(plain.path());
  // computed properties share values with others, so they are tested in a second run
  for (const bool views : {false, true}) {
    std::string text = kEverything;
    text += "sim:on_start(function()\n";
    std::vector<std::string> args = {"", "--fast", "--ticks", "0"};
    std::vector<std::string> wanted;
    for (const Sample& sample : samples(fixture.engine.store())) {
      for (const Property& property : sample.table->properties()) {
        if (!property.writable() || property.computed() != views) continue;
        const std::vector<double> value = non_default_value(property);
        args.emplace_back("--set");
        args.push_back(fmt::format("{}/{}={}", sample.path, property.name,
                                   property.type == PropertyType::choice
                                       ? property.choices[static_cast<std::size_t>(value[0])]
                                       : fmt::format("{}", fmt::join(value, ","))));
        text += "  print(" + lua_numbers(property, sample.lua + "." + property.name) + ")\n";
        wanted.push_back(expected(property, value));
      }
    }
    EXPECT_GT(wanted.size(), views ? 5U : 40U);
    const SceneFile scene(text + "end)\n");
    args[0] = scene.path();
    const RunResult result = run(args);
    EXPECT_EQ(result.code, 0) << result.err;
    std::istringstream lines(result.out);
    std::string line;
    std::size_t at = 0;
    for (const std::string& want : wanted) {
      std::getline(lines, line);
      while (at + 1 < args.size() && args[at] != "--set") at++;
      EXPECT_EQ(line, want) << args[at + 1];
      at += 2;
    }
  }
}

}  // namespace
}  // namespace limber::app::test
