// Preset text format: round trips are bit-exact; damaged texts are rejected or reported.
#include "engine/presets/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "base/random.h"
#include "support/skip.h"

namespace limber::engine {
namespace {

// a preset with properties of every type
std::shared_ptr<const Preset> sample(const std::string& name, Random& random) {
  const auto number = [&] { return random.uniform(-1, 1) * std::pow(10, random.uniform(-300, 300)); };
  PresetBuilder builder;
  for (const char* path : {"/physics/sim", "/physics/body/my%20arm/part/ü", "/scene"}) {
    PresetLayout layout;
    layout.add({"n", PropertyType::number, 1, {}});
    layout.add({"b", PropertyType::boolean, 1, {}});
    layout.add({"c", PropertyType::choice, 1, {"a \"quoted\" label\n"}});
    layout.add({"v", PropertyType::vec3, 3, {}});
    layout.add({"f", PropertyType::flags3, 3, {}});
    layout.add({"q", PropertyType::quat, 4, {}});
    layout.add({"other", PropertyType::none, 2, {}});
    std::vector<double> values{number(), 1, 0, number(), -0.0, number(), 1, 0, 1};
    for (int i = 0; i < 6; i++) values.push_back(number());
    builder.add(path, std::move(layout), values);
  }
  return builder.finish(name, {{"/physics//*"}, {"/scene/x*"}, true, false});
}

bool same(const Preset& a, const Preset& b) {
  return a.name == b.name && a.selection == b.selection && *a.schema == *b.schema && a.routes == b.routes &&
         a.values.size() == b.values.size() &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(double)) == 0;
}

class PresetText : public testing::Test {
 protected:
  void SetUp() override { LIMBER_SKIP_IF(kThreadSanitizer, "its tests use one thread"); }
};

TEST_F(PresetText, RoutesAreReadBack) {
  PresetBuilder builder;
  EXPECT_TRUE(builder.add_route({"my \"route\"", "/physics/sim/time", "/scene/n"}));
  EXPECT_TRUE(builder.add_route({"second", "/a//*", "/b.x"}));
  EXPECT_FALSE(builder.add_route({"second", "/a", "/b"}));
  const PresetList list{builder.finish("p", {})};
  const Result<ParsedPresets> read = parse_presets(text_of(list));
  ASSERT_TRUE(read.ok()) << read.error();
  EXPECT_TRUE(read->problems.empty());
  EXPECT_EQ(read->presets.at(0)->routes, list[0]->routes);
  EXPECT_EQ(list[0]->routes.size(), 2u);
}

TEST_F(PresetText, BadRoutesAreReported) {
  const Result<ParsedPresets> read = parse_presets(R"({ "limber presets": 1, "presets": [ { "name": "p", "routes": [
      ["a", "/x", "/y"], ["a", "/x", "/z"], ["b", "/x"], ["c", "x", "/y"], ["d", "/x", "/y", "/z"], ["", "/x", "/y"],
      ["e", 5, "/y"], 6 ], "values": {} } ] })");
  ASSERT_TRUE(read.ok()) << read.error();
  const std::vector<PresetRoute> expected{{"a", "/x", "/y"}, {"d", "/x", "/y"}};  // the last text of d is reported
  EXPECT_EQ(read->presets.at(0)->routes, expected);
  EXPECT_GE(read->problems.size(), 6u);
}

TEST_F(PresetText, RoundTripIsExact) {
  Random random(1, "text");
  for (int i = 0; i < 50; i++) {
    const PresetList list{sample("one", random), sample("two", random)};
    const Result<ParsedPresets> read = parse_presets(text_of(list));
    ASSERT_TRUE(read.ok()) << read.error();
    EXPECT_TRUE(read->problems.empty());
    ASSERT_EQ(read->presets.size(), 2U);
    EXPECT_TRUE(same(*read->presets[0], *list[0]) && same(*read->presets[1], *list[1]));
    EXPECT_EQ(read->presets[0]->schema, read->presets[1]->schema) << "equal schemas are shared";
    EXPECT_EQ(text_of(read->presets), text_of(list));
  }
}

TEST_F(PresetText, WritesOneValuePerLine) {
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

TEST_F(PresetText, RejectsTruncatedText) {
  Random random(2, "text");
  const std::string text = text_of({sample("one", random), sample("two", random)});
  for (std::size_t size = 1; size + 2 < text.size(); size++) {
    const Result<ParsedPresets> read = parse_presets(std::string_view(text).substr(0, size));
    ASSERT_FALSE(read.ok()) << size;
    EXPECT_TRUE(read.error().starts_with("it is truncated") || read.error().starts_with("parse error at"))
        << read.error();
  }
  EXPECT_TRUE(parse_presets("")->presets.empty());
  EXPECT_TRUE(parse_presets(" \n")->presets.empty());
}

TEST_F(PresetText, RejectsOtherText) {
  struct Case {
    const char* text;
    const char* error;  // prefix
  };
  constexpr Case kCases[] = {
      {"{}", "it is not a preset file: it has no \"limber presets\""},
      {"[]", "it is not a preset file"},
      {"3", "it is not a preset file"},
      {R"({ "limber presets": 2, "presets": [] })", "version 2 is not supported; a newer Limber has written it"},
      {R"({ "presets": [] })", "it is not a preset file: it has no"},
      {R"({ "limber presets": 1, "presets": [ { "name": "a", "values": { "/scene": { "x": NaN } } } ] })",
       "parse error at line 1, column 81"},
      {R"({ "limber presets": 1, "presets": [ { "name": "a", "values": { "/scene": { "x": 1e999 } } } ] })",
       "after 85 bytes: number overflow parsing '1e999'"},
      {"{ \"limber presets\": 1 } x", "parse error at line 1, column 25"},
      {"\xff\xfe{", "parse error at line 1, column 1"},
  };
  for (const Case& c : kCases) {
    const Result<ParsedPresets> read = parse_presets(c.text);
    ASSERT_FALSE(read.ok()) << c.text;
    EXPECT_TRUE(read.error().starts_with(c.error)) << c.text << ": " << read.error();
  }
  const std::string deep = R"({ "limber presets": 1, "else": )" + std::string(100000, '[');
  EXPECT_EQ(parse_presets(deep).error(), "it is nested too deep");
}

// Returns the problem reported for a preset with these values.
std::string problem_of(const std::string& values) {
  const Result<ParsedPresets> read =
      parse_presets(R"({ "limber presets": 1, "presets": [ { "name": "a", "values": {)" + values + "} } ] }");
  if (!read) return "error: " + read.error();
  EXPECT_LE(read->problems.size(), 1U);
  EXPECT_EQ(read->presets.size(), 1U);
  return read->problems.empty() ? "" : read->problems[0];
}

TEST_F(PresetText, ReportsInvalidValues) {
  EXPECT_EQ(problem_of(R"("/scene": { "x": "NaN" })"), "") << "text is the label of a choice";
  EXPECT_EQ(problem_of(R"("/scene": { "x": null })"), "preset 'a', /scene: 'x' has a value of no known type");
  EXPECT_EQ(problem_of(R"("/scene": { "x": [1, "a"] })"), "preset 'a', /scene: 'x' has a value of no known type");
  EXPECT_EQ(problem_of(R"("/scene": { "x": [] })"), "preset 'a', /scene: 'x' has a value of no known type");
  EXPECT_EQ(problem_of(R"("/scene": { "x": [[1], 2] })"), "preset 'a', /scene: 'x' has a value of no known type");
  EXPECT_EQ(problem_of(R"("/scene": { "x": { "y": 1 } })"), "preset 'a', /scene: 'x' has a value of no known type");
  EXPECT_EQ(problem_of(R"("/scene": { "x": 1, "x": 2 })"), "preset 'a', /scene: 'x' is a duplicate");
  EXPECT_EQ(problem_of(R"("/scene": { "x": 1 }, "/scene": { "y": 2 })"), "preset 'a': '/scene' is a duplicate");
  EXPECT_EQ(problem_of(R"("scene": { "x": 1 })"), "preset 'a': 'scene' is not a valid path");
  EXPECT_EQ(problem_of(R"("/scene": 3)"), "'values': unexpected value 3");
  EXPECT_EQ(problem_of(R"("/)" + std::string(10000, '/') + R"(": { "x": 1 })").substr(0, 17), "preset 'a': '////");
}

TEST_F(PresetText, MakesNamesUnique) {
  const auto read = parse_presets(R"({ "limber presets": 1, "presets": [
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
  EXPECT_EQ(read->problems[0], "two presets are named 'a'; renamed the second to 'a 2'");
  EXPECT_EQ(read->presets[1]->values, (std::vector<double>{2}));
}

TEST_F(PresetText, ReadsAHundredMegabytes) {
  LIMBER_SKIP_IF(kAddressSanitizer, "shorter tests execute the same code");
  std::string text = R"({ "limber presets": 1, "presets": [ { "name": "large", "values": {)";
  std::size_t node_count = 0;
  while (text.size() < 100'000'000) {
    text += fmt::format("{}\n\"/physics/body/b{}/part/p\": {{ \"mass\": {}, \"gap\": [1, 2, 3]{} }}",
                        node_count == 0 ? "" : ",", node_count, node_count,
                        node_count % 100 == 0 ? ", \"long\": \"" + std::string(20000, 'x') + "\"" : "");
    node_count++;
  }
  text += "} } ] }";
  const Result<ParsedPresets> read = parse_presets(text);
  ASSERT_TRUE(read.ok()) << read.error();
  EXPECT_TRUE(read->problems.empty());
  const Preset& preset = *read->presets.at(0);
  EXPECT_EQ(preset.schema->property_count(), 2 * node_count + (node_count + 99) / 100);
  EXPECT_EQ(preset.schema->layouts().size(), 2U);
  const PresetSchema::Node& last = preset.schema->nodes().back();
  EXPECT_EQ(preset.values[last.offset], static_cast<double>(node_count - 1));
}

}  // namespace
}  // namespace limber::engine
