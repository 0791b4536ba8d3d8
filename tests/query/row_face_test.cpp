// How rows show themselves: every class's rows, and one of each type against what OSCQuery asks for.
#include "query/row_face.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/engine.h"

namespace limber {
namespace {

using nlohmann::json;
using namespace rows;

Row with_step(Row row, double step) {
  row.step = step;
  return row;
}

// tables of the tests' own live as long as the program, as all do
const Table& samples() {
  static const Table table(
      "sample", "/sample", "",
      {with_step(number("level", "kg", 1, 0, 10, "How full. More of it."), 0.5),
       number("free", "", 0, -kUnbounded, kUnbounded, "Any number: none is wrong."),
       number("above", "", 0, 0, kUnbounded, "Half a range; the other half is open."),
       integer("count", 3, 0, 100, "How many."), state(integer("seed", 1, 0, 9007199254740992, "Big.")),
       readout(integer("tick", 0, 0, kUnbounded, "Counts.")), boolean("on", true, "Whether."),
       choice("style", {"calm", "wild \"one\""}, 1, "How."), vec3("where", "m", {0, 0, 1}, -1, 2, "A place."),
       vec3("diffuse_color", "hsb", {0, 0, 1}, 0, 1, "Colour."), flags3("which", {true, false, true}, "Axes."),
       state(quat("turn", "A rotation.")), action("press", 0, 0, "Pressed."), action("step", 0, 1, "Pressed or told."),
       action("push", 3, 6, "Pushed at a point."), text("fault", "Why it rests."),
       number("talk", "", 0, 0, 1, std::string(70, 'x') + " is a clause too long for a label.")});
  return table;
}

// the row's attributes as one object
json face(const Row& row) {
  json object = json::object();
  for (const auto& [name, text] : attributes_of(row)) object[std::string(name)] = json::parse(text);
  EXPECT_EQ(json::parse("{\"X\":0" + attributes_text(row) + "}").size(), object.size() + 1);
  return object;
}
json face(const char* name) { return face(samples().at(name)); }

TEST(RowFace, EachTypeAsItsTagsSay) {
  const std::vector<std::pair<const char*, const char*>> expected = {{"level", "f"},   {"free", "f"},
                                                                     {"count", "i"},   {"seed", "h"},
                                                                     {"tick", "i"},    {"on", "T"},
                                                                     {"style", "s"},   {"where", "fff"},
                                                                     {"which", "TTT"}, {"turn", "[ffff]"},
                                                                     {"press", "N"},   {"step", "N"},
                                                                     {"push", "fff"},  {"diffuse_color", "fff"},
                                                                     {"fault", "s"}};
  for (const auto& [name, tags] : expected) EXPECT_EQ(tags_of(samples().at(name)), tags) << name;
}

TEST(RowFace, Attributes) {
  EXPECT_EQ(face("level"), json::parse(R"({"TYPE":"f","ACCESS":3,"DESCRIPTION":"How full","RANGE":[{"MIN":0,"MAX":10}],
      "CLIPMODE":["both"],"UNIT":["kg"],"DEFAULT_VALUE":[1],"STEP_SIZE":[0.5],"DOC":"How full. More of it."})"));
  EXPECT_EQ(face("free"), json::parse(R"({"TYPE":"f","ACCESS":3,"DESCRIPTION":"Any number","DEFAULT_VALUE":[0],
      "DOC":"Any number: none is wrong."})"));
  EXPECT_EQ(face("above")["RANGE"], json::parse(R"([{"MIN":0}])"));
  EXPECT_EQ(face("above")["CLIPMODE"], json::parse(R"(["low"])"));
  EXPECT_EQ(face("style"),
            json::parse(R"({"TYPE":"s","ACCESS":3,"DESCRIPTION":"How","RANGE":[{"VALS":["calm","wild \"one\""]}],
      "DEFAULT_VALUE":["wild \"one\""],"DOC":"How."})"));
  EXPECT_EQ(face("where")["RANGE"], json::parse(R"([{"MIN":-1,"MAX":2},{"MIN":-1,"MAX":2},{"MIN":-1,"MAX":2}])"));
  EXPECT_EQ(face("where")["UNIT"], json::parse(R"(["m","m","m"])"));
  EXPECT_EQ(face("turn")["RANGE"][0].size(), 4u) << "nested as its tags are";
  EXPECT_EQ(face("turn")["EXTENDED_TYPE"], json::parse(R"(["quaternion"])"));
  EXPECT_EQ(face("diffuse_color")["EXTENDED_TYPE"], json::parse(R"(["hue","saturation","brightness"])"));
  EXPECT_FALSE(face("which").contains("RANGE"));
  EXPECT_FALSE(face("tick").contains("CLIPMODE")) << "nothing is clipped where nothing can be set";
  EXPECT_EQ(face("tick")["ACCESS"], 1);
  EXPECT_EQ(face("press")["ACCESS"], 2);
  EXPECT_EQ(face("talk")["DESCRIPTION"], "talk");
}

TEST(RowFace, ValuesAreArraysAndMessagesSayTheSame) {
  const auto value = [](const char* name, std::array<double, 4> v) {
    return value_json(samples().at(name), {v.data(), {}});
  };
  EXPECT_EQ(value("level", {0.1}), "[0.1]");
  EXPECT_EQ(value("seed", {9007199254740992}), "[9007199254740992]");
  EXPECT_EQ(value("on", {1}), "[true]");
  EXPECT_EQ(value("style", {1}), R"(["wild \"one\""])");
  EXPECT_EQ(value("where", {1, -2.5, 1e20}), "[1,-2.5,1e+20]");
  EXPECT_EQ(value("which", {1, 0, 1}), "[true,false,true]");
  EXPECT_EQ(value("turn", {0, 0, 0, 1}), "[[0,0,0,1]]");
  EXPECT_EQ(value("level", {std::nan("")}), "[null]") << "JSON knows no NaN";
  EXPECT_EQ(value_json(samples().at("fault"), {nullptr, "a \"nil\""}), R"(["a \"nil\""])");
  EXPECT_EQ(value_message("/f", samples().at("fault"), {nullptr, "nil"}).args.at(0).text, "nil");
  EXPECT_EQ(access_of(samples().at("fault")), 1);
  const double third[] = {1, 0, 1};
  const Message flags = value_message("/w", samples().at("which"), {third, {}});
  EXPECT_EQ(flags.args[0].kind, Arg::Kind::boolean);
  EXPECT_EQ(flags.args.size(), 3u);
  const double label[] = {1};
  EXPECT_EQ(value_message("/s", samples().at("style"), {label, {}}).args.at(0).text, "wild \"one\"");
}

// the rows that Limber has: what a client may rely on
TEST(RowFace, EveryRowOfEveryClass) {
  int rows = 0;
  for (const Table* table : {&World::table(), &Body::table(), &Part::table(), &Joint::table(), &Motor::table(),
                             &Transport::table(), &CounterNode::table()}) {
    for (const Row& row : table->rows()) {
      const json attributes = face(row);
      const std::string tags = attributes["TYPE"];
      EXPECT_EQ(tags.find("ffff") != std::string::npos, tags == "[ffff]") << row.name;
      EXPECT_LE(attributes["DESCRIPTION"].get<std::string>().size(), 60u) << row.name;
      EXPECT_FALSE(attributes["DESCRIPTION"].get<std::string>().empty()) << row.name;
      const std::size_t elements = tags.front() == '[' ? 1 : tags.size();
      for (const char* each : {"RANGE", "UNIT", "CLIPMODE", "DEFAULT_VALUE"}) {
        if (attributes.contains(each)) {
          EXPECT_TRUE(attributes[each].is_array() && attributes[each].size() == elements) << row.name << " " << each;
        }
      }
      for (const auto& [name, unused] : attributes.items()) {
        const auto& known = known_attributes();
        EXPECT_NE(std::find(known.begin(), known.end(), name), known.end()) << name;
      }
      rows++;
    }
  }
  EXPECT_GT(rows, 90);
}

}  // namespace
}  // namespace limber
