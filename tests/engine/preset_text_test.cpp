// Files of presets as texts: what is written reads back to the bit, what is damaged is refused or said.
#include "engine/preset_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "base/random.h"

namespace limber {
namespace {

// one thing of every kind of row
std::shared_ptr<const Preset> sample(const std::string& name, Random& random) {
  const auto number = [&] { return random.uniform(-1, 1) * std::pow(10, random.uniform(-300, 300)); };
  PresetBuilder builder;
  for (const char* path : {"/physics/sim", "/physics/body/my%20arm/part/ü", "/scene"}) {
    PresetClass rows;
    rows.add({"n", RowType::number, 1, {}});
    rows.add({"b", RowType::boolean, 1, {}});
    rows.add({"c", RowType::choice, 1, {"a \"quoted\" label\n"}});
    rows.add({"v", RowType::vec3, 3, {}});
    rows.add({"f", RowType::flags3, 3, {}});
    rows.add({"q", RowType::quat, 4, {}});
    rows.add({"other", RowType::none, 2, {}});
    std::vector<double> values{number(), 1, 0, number(), -0.0, number(), 1, 0, 1};
    for (int i = 0; i < 6; i++) values.push_back(number());
    builder.give(builder.thing(path), std::move(rows), values);
  }
  return builder.finish(name, {{"/physics//*"}, {"/scene/x*"}, true, false});
}

bool same(const Preset& a, const Preset& b) {
  return a.name == b.name && a.choice == b.choice && *a.shape == *b.shape && a.values.size() == b.values.size() &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(double)) == 0;
}

TEST(PresetText, ReadsBackToTheBit) {
  Random random(1, "text");
  for (int i = 0; i < 50; i++) {
    const PresetList list{sample("one", random), sample("two", random)};
    const Result<PresetsRead> read = presets_of(text_of(list));
    ASSERT_TRUE(read.ok()) << read.error();
    EXPECT_TRUE(read->problems.empty());
    ASSERT_EQ(read->presets.size(), 2U);
    EXPECT_TRUE(same(*read->presets[0], *list[0]) && same(*read->presets[1], *list[1]));
    EXPECT_EQ(read->presets[0]->shape, read->presets[1]->shape) << "alike things are told of once";
    EXPECT_EQ(text_of(read->presets), text_of(list));
  }
}

TEST(PresetText, AValueALine) {
  Random random(1, "text");
  const std::string text = text_of({sample("one", random)});
  EXPECT_TRUE(text.starts_with(R"({
  "limber presets": 1,
  "presets": [
    {
      "name": "one",
      "rows": ["/physics//*"],
      "except": ["/scene/x*"],
      "poses": true,
      "values": {
        "/physics/sim": {
          "n": )"))
      << text.substr(0, 300);
  EXPECT_NE(text.find("\n          \"b\": true,\n          \"c\": \"a \\\"quoted\\\" label\\n\",\n"),
            std::string::npos);
  EXPECT_NE(text.find("\n        \"/physics/body/my%20arm/part/ü\": {\n"), std::string::npos);
  EXPECT_EQ(text_of(PresetList{}), "{\n  \"limber presets\": 1,\n  \"presets\": []\n}\n");
}

TEST(PresetText, HalfAFileIsNoFile) {
  Random random(2, "text");
  const std::string text = text_of({sample("one", random), sample("two", random)});
  for (std::size_t size = 1; size + 2 < text.size(); size++) {
    const Result<PresetsRead> read = presets_of(std::string_view(text).substr(0, size));
    ASSERT_FALSE(read.ok()) << size;
    EXPECT_TRUE(read.error().starts_with("it ends in the middle") || read.error().starts_with("parse error at"))
        << read.error();
  }
  EXPECT_TRUE(presets_of("")->presets.empty());
  EXPECT_TRUE(presets_of(" \n")->presets.empty());
}

TEST(PresetText, WhatIsNoFileOfPresetsIsRefused) {
  struct Case {
    const char* text;
    const char* error;  // its beginning
  };
  constexpr Case kCases[] = {
      {"{}", "it is no file of presets: there is no \"limber presets\" in it"},
      {"[]", "it is no file of presets"},
      {"3", "it is no file of presets"},
      {R"({ "limber presets": 2, "presets": [] })",
       "it is of version 2, which this Limber does not know; a newer one has written it"},
      {R"({ "presets": [] })", "it is no file of presets: there is no"},
      {R"({ "limber presets": 1, "presets": [ { "name": "a", "values": { "/scene": { "x": NaN } } } ] })",
       "parse error at line 1, column 81"},
      {R"({ "limber presets": 1, "presets": [ { "name": "a", "values": { "/scene": { "x": 1e999 } } } ] })",
       "after 85 bytes: number overflow parsing '1e999'"},
      {"{ \"limber presets\": 1 } x", "parse error at line 1, column 25"},
      {"\xff\xfe{", "parse error at line 1, column 1"},
  };
  for (const Case& c : kCases) {
    const Result<PresetsRead> read = presets_of(c.text);
    ASSERT_FALSE(read.ok()) << c.text;
    EXPECT_TRUE(read.error().starts_with(c.error)) << c.text << ": " << read.error();
  }
  const std::string deep = R"({ "limber presets": 1, "else": )" + std::string(100000, '[');
  EXPECT_EQ(presets_of(deep).error(), "it is nested too deep");
}

// what stands in a preset's values, and what is said of it
std::string problem_of(const std::string& values) {
  const Result<PresetsRead> read =
      presets_of(R"({ "limber presets": 1, "presets": [ { "name": "a", "values": {)" + values + "} } ] }");
  if (!read) return "error: " + read.error();
  EXPECT_LE(read->problems.size(), 1U);
  EXPECT_EQ(read->presets.size(), 1U);
  return read->problems.empty() ? "" : read->problems[0];
}

TEST(PresetText, WhatIsNotUnderstoodIsSaid) {
  EXPECT_EQ(problem_of(R"("/scene": { "x": "NaN" })"), "") << "text is a label, until a number is asked for";
  EXPECT_EQ(problem_of(R"("/scene": { "x": null })"), "preset 'a', /scene: 'x' has no value that any row has");
  EXPECT_EQ(problem_of(R"("/scene": { "x": [1, "a"] })"), "preset 'a', /scene: 'x' has no value that any row has");
  EXPECT_EQ(problem_of(R"("/scene": { "x": [] })"), "preset 'a', /scene: 'x' has no value that any row has");
  EXPECT_EQ(problem_of(R"("/scene": { "x": [[1], 2] })"), "preset 'a', /scene: 'x' has no value that any row has");
  EXPECT_EQ(problem_of(R"("/scene": { "x": { "y": 1 } })"), "preset 'a', /scene: 'x' has no value that any row has");
  EXPECT_EQ(problem_of(R"("/scene": { "x": 1, "x": 2 })"), "preset 'a', /scene: 'x' stands there twice");
  EXPECT_EQ(problem_of(R"("/scene": { "x": 1 }, "/scene": { "y": 2 })"), "preset 'a': '/scene' stands there twice");
  EXPECT_EQ(problem_of(R"("scene": { "x": 1 })"), "preset 'a': 'scene' is no path of a thing");
  EXPECT_EQ(problem_of(R"("/scene": 3)"), "3 is nothing for 'values'");
  EXPECT_EQ(problem_of(R"("/)" + std::string(10000, '/') + R"(": { "x": 1 })").substr(0, 17), "preset 'a': '////");
}

TEST(PresetText, NoTwoOfAName) {
  const auto read = presets_of(R"({ "limber presets": 1, "presets": [
    { "name": "a", "values": { "/scene": { "x": 1 } } },
    { "name": "a", "values": { "/scene": { "x": 2 } } },
    { "name": "", "values": {} },
    { "name": "script", "values": {} },
    { "name": "a" } ] })");
  ASSERT_TRUE(read.ok()) << read.error();
  std::vector<std::string> names;
  for (const auto& preset : read->presets) names.push_back(preset->name);
  EXPECT_EQ(names, (std::vector<std::string>{"a", "a 2", "unnamed 2", "unnamed 3", "a 3"}));
  EXPECT_EQ(read->problems.size(), 4U);
  EXPECT_EQ(read->problems[0], "two presets are called 'a'; the second is 'a 2' now");
  EXPECT_EQ(read->presets[1]->values, (std::vector<double>{2}));
}

TEST(PresetText, AHundredMegabytes) {
  std::string text = R"({ "limber presets": 1, "presets": [ { "name": "large", "values": {)";
  std::size_t things = 0;
  while (text.size() < 100'000'000) {
    text += fmt::format("{}\n\"/physics/body/b{}/part/p\": {{ \"mass\": {}, \"gap\": [1, 2, 3]{} }}",
                        things == 0 ? "" : ",", things, things,
                        things % 100 == 0 ? ", \"long\": \"" + std::string(20000, 'x') + "\"" : "");
    things++;
  }
  text += "} } ] }";
  const Result<PresetsRead> read = presets_of(text);
  ASSERT_TRUE(read.ok()) << read.error();
  EXPECT_TRUE(read->problems.empty());
  const Preset& preset = *read->presets.at(0);
  EXPECT_EQ(preset.shape->row_count(), 2 * things + (things + 99) / 100);
  EXPECT_EQ(preset.shape->classes().size(), 2U);
  const PresetShape::Thing& last = preset.shape->things().back();
  EXPECT_EQ(preset.values[last.at], static_cast<double>(things - 1));
}

}  // namespace
}  // namespace limber
