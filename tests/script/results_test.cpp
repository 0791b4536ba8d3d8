// result and sim:record: declared results and sampled columns.
#include <cmath>

#include <gtest/gtest.h>

#include "script/scene/scene.h"
#include "stage.h"

namespace limber::script {
namespace {

TEST(Results, AreComputedAtTheEnd) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
local steps = 0
sim:on_step(function() steps = steps + 1 end)
result("steps", function() return steps end)
result("moved", function() return steps > 2 end, { min = 0, max = 2, cells = 4 })
)"),
            "");
  fixture.tick(3);
  const std::vector<SceneResult>& results = fixture.scene.compute_results();
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].name, "steps");
  EXPECT_EQ(results[0].value, 3);
  EXPECT_EQ(results[0].cells, 0);
  EXPECT_EQ(results[1].value, 1);
  EXPECT_EQ(results[1].min, 0);
  EXPECT_EQ(results[1].max, 2);
  EXPECT_EQ(results[1].cells, 4);
}

TEST(Results, AFailedOneHasAnErrorAndTheOthersAreComputed) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
result("missing", function() return nothing.x end)
result("text", function() return "far" end)
result("nan", function() return 0 / 0 end)
result("good", function() return 7 end)
)"),
            "");
  const std::vector<SceneResult>& results = fixture.scene.compute_results();
  ASSERT_EQ(results.size(), 4u);
  EXPECT_NE(results[0].error.find(":2: there is no global 'nothing'"), std::string::npos) << results[0].error;
  EXPECT_NE(results[1].error.find("result 'text': the function returns a number, not 'far'"), std::string::npos)
      << results[1].error;
  EXPECT_EQ(results[2].error, "result 'nan' is nan");
  EXPECT_TRUE(std::isnan(results[0].value) && std::isnan(results[1].value) && std::isnan(results[2].value));
  EXPECT_EQ(results[3].value, 7);
  EXPECT_EQ(results[3].error, "");
}

TEST(Results, DeclarationsAreChecked) {
  const auto error = [](const std::string& text) { return ScriptFixture().run(text); };
  for (const auto& [text, message] : std::initializer_list<std::pair<const char*, const char*>>{
           {"result('a', print) result('a', print)", "there is a result 'a' already; names are unique"},
           {"result('a b', print)", "result takes a name of letters, digits and _, not 'a b'"},
           {"result('a', print, { min = 0, max = 1, cells = 0 })", "cells is a whole number 1 .. 1000, not 0"},
           {"result('a', print, { min = 0 })", "result 'a': max takes a number, not nothing"},
           {"result('a', print, { low = 0 })", "'low'"},
           {"for i = 1, 65 do result('a' .. i, print) end", "more than 64 results"},
           {"sim:record { { 'tick', print } }", "each row has the column 'tick' already"},
           {"sim:record { { 'a', print }, { 'a', print } }", "there is a column 'a' already; names are unique"},
           {"sim:record { height = print }", "'height' is not a column"},
           {"sim:record { 'height' }", "column 1 is { \"name\", function() return … end }, not 'height'"},
           {"sim:record { { 'a', print } } sim:record { { 'b', print } }", "sim:record is called once"}}) {
    const std::string found = error(text);
    EXPECT_NE(found.find(message), std::string::npos) << found;
  }
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play("sim:on_step(function() result('late', print) end)"), "");
  fixture.tick(1);
  ASSERT_EQ(fixture.host.faults.size(), 1u);
}

constexpr const char* kColumns = R"(
local n = 0
sim:on_step(function() n = n + 1 end)
sim:record { rate = 20, { "n", function() return n end }, { "odd", function() return n % 2 == 1 end } }
)";

// 60 ticks a second and 20 rows: each third tick, from the first one, which has the number 0.
TEST(Record, SamplesAtItsRate) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(kColumns), "");
  RecordedRows& rows = fixture.scene.output().rows;
  EXPECT_EQ(rows.columns(), (std::vector<std::string>{"n", "odd"}));
  rows.enable();
  fixture.tick(7);
  ASSERT_EQ(rows.rows().size(), 3 * rows.width());
  for (std::size_t row = 0; row < 3; row++) {
    const double* const values = rows.rows().data() + row * rows.width();
    const auto tick = static_cast<double>(3 * row);
    EXPECT_EQ(values[0], tick);
    EXPECT_NEAR(values[1], tick / 60, 1e-9);
    EXPECT_EQ(values[2], tick + 1);
    EXPECT_EQ(values[3], row % 2 == 0 ? 1 : 0);
  }
}

TEST(Record, StoresNothingUnlessEnabledAndDropsWhatDoesNotFit) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(kColumns), "");
  RecordedRows& rows = fixture.scene.output().rows;
  fixture.tick(6);
  EXPECT_TRUE(rows.rows().empty());
  rows.enable();
  const double values[] = {1, 2};
  for (int i = 0; i < 20000; i++) rows.add(0, 0, values);
  EXPECT_EQ(rows.rows().size() / rows.width() + rows.dropped(), 20000u);
  EXPECT_EQ(rows.rows().size(), std::size_t{1} << 16);
  rows.clear_rows();
  rows.set_muted(true);
  rows.add(0, 0, values);
  EXPECT_TRUE(rows.rows().empty());
}

TEST(Record, AFailedColumnIsReportedOnceAndEndsTheRows) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play("sim:record { { 'a', function() return nothing end } }"), "");
  fixture.scene.output().rows.enable();
  fixture.tick(5);
  ASSERT_EQ(fixture.host.faults.size(), 1u);
  EXPECT_TRUE(fixture.scene.output().rows.rows().empty());
}

}  // namespace
}  // namespace limber::script
