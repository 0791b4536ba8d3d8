// Every row through `--set`: the scene reads it back in its first callback.
#include <sstream>

#include <fmt/ranges.h>

#include "app/program.h"
#include "engine/every_row.h"
#include "engine/show.h"

namespace limber::app_test {
namespace {

using namespace engine_test;

std::string expected(const Row& row, const std::vector<double>& value) {
  if (row.type == RowType::choice) return row.choices[static_cast<std::size_t>(value[0])];
  std::string text;
  for (const double v : value) {
    if (!text.empty()) text += "\t";
    const bool flag = row.type == RowType::boolean || row.type == RowType::flags3;
    text += flag ? (v != 0 ? "true" : "false") : fmt::format("{:.14g}", v);
  }
  return text;
}

TEST(EveryRow, BySet) {
  const SceneFile plain(kEverything);
  Show rig(plain.path());
  // what sets the same numbers as another row goes into a run of its own
  for (const bool views : {false, true}) {
    std::string text = kEverything;
    text += "sim:on_start(function()\n";
    std::vector<std::string> args = {"", "--fast", "--ticks", "0"};
    std::vector<std::string> wanted;
    for (const Sample& sample : samples(rig.engine.store())) {
      for (const Row& row : sample.table->rows()) {
        if (!row.writable() || row.view() != views) continue;
        const std::vector<double> value = other_value(row);
        args.emplace_back("--set");
        args.push_back(fmt::format("{}/{}={}", sample.path, row.name,
                                   row.type == RowType::choice ? row.choices[static_cast<std::size_t>(value[0])]
                                                               : fmt::format("{}", fmt::join(value, ","))));
        text += "  print(" + lua_numbers(row, sample.lua + "." + row.name) + ")\n";
        wanted.push_back(expected(row, value));
      }
    }
    EXPECT_GT(wanted.size(), views ? 5U : 40U);
    const SceneFile scene(text + "end)\n");
    args[0] = scene.path();
    const Ran ran = run(args);
    EXPECT_EQ(ran.code, 0) << ran.err;
    std::istringstream lines(ran.out);
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
}  // namespace limber::app_test
