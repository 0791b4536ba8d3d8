// Random Lua programs give the same result compiled and interpreted: each runs in a scene that LuaJIT compiles, and in
// one that it only interprets, both in separate processes. LIMBER_LUA_PROGRAMS and LIMBER_LUA_SEED set the number of
// programs and the first seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/sanitized.h"
#include "lua_program.h"
#include "lua_runs.h"

namespace limber::script {
namespace {

using test::LuaProgram;
using test::make_program;
using test::run_texts;

using Results = std::vector<std::string>;

// Loops are compiled after two iterations, so that short programs are compiled.
Results results_of(const std::vector<std::string>& texts, bool compiled) { return run_texts(texts, {compiled, 2}); }

bool differs(const LuaProgram& program) {
  const std::vector<std::string> texts{program.text()};
  return results_of(texts, true) != results_of(texts, false);
}

std::uint64_t number_of(const char* variable, std::uint64_t missing) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? missing : std::strtoull(text, nullptr, 10);
}

// Returns the minimized program of a seed that differs, with both results.
std::string report(std::uint64_t seed, const std::string& compiled, const std::string& interpreted) {
  constexpr const char* kFormat = "program {}:\n{}--- compiled:\n{}\n--- interpreted:\n{}\n";
  LuaProgram program = make_program(seed);
  if (!differs(program)) {
    return "only after the preceding programs, " + fmt::format(kFormat, seed, program.text(), compiled, interpreted);
  }
  program = test::shrink(program, differs, 400);
  const std::vector<std::string> texts{program.text()};
  return fmt::format(kFormat, seed, texts[0], results_of(texts, true)[0], results_of(texts, false)[0]);
}

// Returns the first difference in a batch, or nothing.
std::optional<std::uint64_t> first_difference(std::uint64_t first, std::uint64_t count, std::string& text) {
  std::vector<std::string> texts;
  for (std::uint64_t i = 0; i < count; i++) texts.push_back(make_program(first + i).text());
  const Results compiled = results_of(texts, true);
  const Results interpreted = results_of(texts, false);
  std::size_t same = 0;
  while (same < std::min(compiled.size(), interpreted.size()) && compiled[same] == interpreted[same]) same++;
  if (same == count) return std::nullopt;
  const auto result = [&](const Results& results) { return same < results.size() ? results[same] : "none"; };
  text = report(first + same, result(compiled), result(interpreted));
  return first + same;
}

TEST(LuaDifference, CompiledProgramsMatchTheInterpreter) {
  const std::uint64_t first = number_of("LIMBER_LUA_SEED", 1);
  const std::uint64_t end = first + number_of("LIMBER_LUA_PROGRAMS", kSanitized ? 20 : 800);
  const std::uint64_t max_reports = number_of("LIMBER_LUA_REPORTS", 1);
  const char* const progress = std::getenv("LIMBER_LUA_PROGRESS");
  constexpr std::uint64_t kBatch = test::kSeriesLength;
  std::uint64_t found = 0;
  for (std::uint64_t seed = first; seed < end && found < max_reports;) {
    const std::uint64_t count = std::min(kBatch, end - seed);
    std::string text;
    const std::optional<std::uint64_t> difference = first_difference(seed, count, text);
    seed = difference ? *difference + 1 : seed + count;
    if (difference) ADD_FAILURE() << text;
    found += difference ? 1U : 0U;
    if (progress != nullptr && found == 0) std::ofstream(progress) << seed << "\n";
  }
}

// Checks that most programs run to their end, rather than failing in the first line.
TEST(LuaDifference, MostProgramsRunToTheirEnd) {
  std::vector<std::string> texts;
  for (std::uint64_t seed = 1; seed <= 100; seed++) texts.push_back(make_program(seed).text());
  const Results results = results_of(texts, false);
  ASSERT_EQ(results.size(), texts.size());
  EXPECT_GT(std::count_if(results.begin(), results.end(), [](const std::string& r) { return r.ends_with("true nil"); }),
            70);
  EXPECT_EQ(
      std::count_if(results.begin(), results.end(), [](const std::string& r) { return r.starts_with("rejected"); }), 0);
}

}  // namespace
}  // namespace limber::script
