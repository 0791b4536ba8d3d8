// OSCQuery attributes: the properties of every class, and one property of each type compared with the specification.
#include "net/oscquery/attributes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "support/world_objects.h"

namespace limber::oscquery {
namespace {

using nlohmann::json;
using namespace properties;

Property with_step(Property property, double step) {
  property.step = step;
  return property;
}

// Property tables of tests live as long as the program, like all tables.
const PropertyTable& samples() {
  static const PropertyTable table(
      "sample", "/sample", "",
      {with_step(number("level", "kg", 1, 0, 10, "How full. More of it."), 0.5),
       number("free", "", 0, -kUnbounded, kUnbounded, "Any number: none is wrong."),
       number("above", "", 0, 0, kUnbounded, "Half a range; the other half is open."),
       integer("count", 3, 0, 100, "How many."), state(integer("seed", 1, 0, 9007199254740992, "Big.")),
       readout(integer("tick", 0, 0, kUnbounded, "Counts.")), boolean("on", true, "Whether."),
       choice("style", {"calm", "wild \"one\""}, 1, "How."), vec3("where", "m", {0, 0, 1}, -1, 2, "A place."),
       vec3("diffuse_color", "hsb", {0, 0, 1}, 0, 1, "Color."), flags3("which", {true, false, true}, "Axes."),
       state(quat("turn", "A rotation.")), action("press", 0, 0, "Pressed."), action("step", 0, 1, "Pressed or sent."),
       action("push", 3, 6, "Pushed at a point."), text("fault", "Why it rests."),
       number("talk", "", 0, 0, 1, std::string(70, 'x') + " is a clause too long for a label.")});
  return table;
}

// Returns the property's attributes as one object.
json attributes(const Property& property) {
  json object = json::object();
  for (const auto& [name, text] : attributes_of(property)) object[std::string(name)] = json::parse(text);
  EXPECT_EQ(json::parse("{\"X\":0" + attributes_text(property) + "}").size(), object.size() + 1);
  return object;
}
json attributes(const char* name) { return attributes(samples().at(name)); }

TEST(OscQueryAttributes, HaveTagsOfEachType) {
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

TEST(OscQueryAttributes, DescribeProperties) {
  EXPECT_EQ(attributes("level"),
            json::parse(R"({"TYPE":"f","ACCESS":3,"DESCRIPTION":"How full","RANGE":[{"MIN":0,"MAX":10}],
      "CLIPMODE":["both"],"UNIT":["kg"],"DEFAULT_VALUE":[1],"STEP_SIZE":[0.5],"DOC":"How full. More of it."})"));
  EXPECT_EQ(attributes("free"), json::parse(R"({"TYPE":"f","ACCESS":3,"DESCRIPTION":"Any number","DEFAULT_VALUE":[0],
      "DOC":"Any number: none is wrong."})"));
  EXPECT_EQ(attributes("above")["RANGE"], json::parse(R"([{"MIN":0}])"));
  EXPECT_EQ(attributes("above")["CLIPMODE"], json::parse(R"(["low"])"));
  EXPECT_EQ(attributes("style"),
            json::parse(R"({"TYPE":"s","ACCESS":3,"DESCRIPTION":"How","RANGE":[{"VALS":["calm","wild \"one\""]}],
      "DEFAULT_VALUE":["wild \"one\""],"DOC":"How."})"));
  EXPECT_EQ(attributes("where")["RANGE"], json::parse(R"([{"MIN":-1,"MAX":2},{"MIN":-1,"MAX":2},{"MIN":-1,"MAX":2}])"));
  EXPECT_EQ(attributes("where")["UNIT"], json::parse(R"(["m","m","m"])"));
  EXPECT_EQ(attributes("turn")["RANGE"][0].size(), 4u) << "nested as its tags are";
  EXPECT_EQ(attributes("turn")["EXTENDED_TYPE"], json::parse(R"(["quaternion"])"));
  EXPECT_EQ(attributes("diffuse_color")["EXTENDED_TYPE"], json::parse(R"(["hue","saturation","brightness"])"));
  EXPECT_FALSE(attributes("which").contains("RANGE"));
  EXPECT_FALSE(attributes("tick").contains("CLIPMODE")) << "nothing is clipped where nothing can be set";
  EXPECT_EQ(attributes("tick")["ACCESS"], 1);
  EXPECT_EQ(attributes("press")["ACCESS"], 2);
  EXPECT_EQ(attributes("talk")["DESCRIPTION"], "talk");
}

TEST(OscQueryAttributes, ValuesMatchMessages) {
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

// The properties of Limber must satisfy the assumptions of clients.
TEST(OscQueryAttributes, CoverEveryProperty) {
  int count = 0;
  for (const PropertyTable* table :
       {&sim::World::table(), &sim::Body::table(), &sim::Part::table(), &sim::Joint::table(), &sim::Motor::table(),
        &engine::Transport::table(), &engine::CounterNode::table()}) {
    for (const Property& property : table->properties()) {
      const json found = attributes(property);
      const std::string tags = found["TYPE"];
      EXPECT_EQ(tags.find("ffff") != std::string::npos, tags == "[ffff]") << property.name;
      EXPECT_LE(found["DESCRIPTION"].get<std::string>().size(), 60u) << property.name;
      EXPECT_FALSE(found["DESCRIPTION"].get<std::string>().empty()) << property.name;
      const std::size_t elements = tags.front() == '[' ? 1 : tags.size();
      for (const char* each : {"RANGE", "UNIT", "CLIPMODE", "DEFAULT_VALUE"}) {
        if (found.contains(each)) {
          EXPECT_TRUE(found[each].is_array() && found[each].size() == elements) << property.name << " " << each;
        }
      }
      for (const auto& [name, unused] : found.items()) {
        const auto& known = known_attributes();
        EXPECT_NE(std::find(known.begin(), known.end(), name), known.end()) << name;
      }
      count++;
    }
  }
  EXPECT_GT(count, 90);
}

}  // namespace
}  // namespace limber::oscquery
