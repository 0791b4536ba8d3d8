// Import of pattrstorage files as Max writes them, and rejection of other files.

#include <gtest/gtest.h>

#include "engine/presets/text.h"

namespace limber::engine {
namespace {

// the presets in Limber's own format
std::string formatted(const ParsedPresets& read) { return text_of(read.presets); }

TEST(PresetImport, SlotsBecomePresets) {
  // with the tabs and commas of pattrstorage
  const auto read = import_pattrstorage(
      "{\n\t\"pattrstorage\" : \t{\n\t\t\"name\" : \"store\",\n\t\t\"slots\" : \t\t{\n"
      "\t\t\t\"10\" : \t\t\t{\n\t\t\t\t\"id\" : 10,\n\t\t\t\t\"data\" : \t\t\t\t{\n"
      "\t\t\t\t\t\"wind\" : [ 3 ]\n\t\t\t\t}\n\n\t\t\t}\n,\n"
      "\t\t\t\"2\" : \t\t\t{\n\t\t\t\t\"id\" : 2,\n\t\t\t\t\"name\" : \"dusk\",\n\t\t\t\t\"data\" : \t\t\t\t{\n"
      "\t\t\t\t\t\"wind\" : [ 0.5 ],\n\t\t\t\t\t\"physics::sim::gravity\" : [ 0.0, 0.0, -1.6 ],\n"
      "\t\t\t\t\t\"/physics/body/arm1/part/tip/mass\" : [ 2.0 ],\n\t\t\t\t\t\"style\" : [ \"wild\" ],\n"
      "\t\t\t\t\t\"list\" : [ 1, 2 ],\n\t\t\t\t\t\"mixed\" : [ 1, \"a\", 3 ]\n\t\t\t\t}\n\t\t\t}\n\t\t}\n\t}\n}\n");
  ASSERT_TRUE(read.ok()) << read.error();
  EXPECT_EQ(formatted(*read), R"({
  "limber presets": 1,
  "presets": [
    {
      "name": "dusk",
      "values": {
        "/physics/body/arm1/part/tip": {
          "mass": 2
        },
        "/physics/sim": {
          "gravity": [0, 0, -1.6]
        },
        "/scene": {
          "style": "wild",
          "wind": 0.5
        }
      }
    },
    {
      "name": "slot 10",
      "values": {
        "/scene": {
          "wind": 3
        }
      }
    }
  ]
}
)");
  EXPECT_EQ(read->problems,
            (std::vector<std::string>{"preset 'dusk': 'list' is ignored: no property has such a value",
                                      "preset 'dusk': 'mixed' is ignored: no property has such a value"}));
}

TEST(PresetImport, RejectsOtherFiles) {
  for (const char* text : {"", "{", "[]", "3", "{ \"pattrstorage\" : 3 ", "\xff"})
    EXPECT_EQ(import_pattrstorage(text).error(),
              "it is not a JSON file; in Max, pattrstorage writes one by the message writejson")
        << text;
  for (const char* text : {"{}", R"({ "pattrstorage": 3 })", R"({ "pattrstorage": { "slots": [] } })"})
    EXPECT_EQ(import_pattrstorage(text).error(),
              "it is not a pattrstorage file; in Max, it writes one by the message writejson");
  const auto odd = import_pattrstorage(R"({ "pattrstorage": { "slots": { "x": {}, "1": { "data": 3 },
      "3": { "name": "script", "data": { "": [1], "::": [1], "a::": [1], "a": [] } },
      "2": { "name": "slot 1" } } } })");
  ASSERT_TRUE(odd.ok()) << odd.error();
  std::vector<std::string> names;
  for (const auto& preset : odd->presets) names.push_back(preset->name);
  EXPECT_EQ(names, (std::vector<std::string>{"slot 1", "slot 1 2", "slot 3"}));
}

}  // namespace
}  // namespace limber::engine
