// Property tables: layout, lookup and description of properties; the list of units.
#include "properties/property_table.h"

#include <gtest/gtest.h>

#include "properties/units.h"

namespace limber {
namespace {

using namespace properties;

TEST(PropertyTable, LaysOutStoredPropertiesInTwoBlocks) {
  const PropertyTable table(
      "thing", "/thing/<thing>", "",
      {number("mass", "kg", 1, 0, 10, ""), transient(state(vec3("position", "m", {0, 0, 0}, -1, 1, ""))),
       flags3("active", {true, false, true}, ""), transient(state(quat("rotation", ""))), action("kick", 0, 1, ""),
       choice("mode", {"off", "on"}, 1, "")});
  const std::uint32_t offsets[] = {0, 0, 1, 3, 0, 4};
  const std::uint32_t widths[] = {1, 3, 3, 4, 0, 1};
  for (std::uint32_t i = 0; i < 6; i++) {
    EXPECT_EQ(table.property(i).index, i);
    EXPECT_EQ(table.property(i).width, widths[i]) << i;
    EXPECT_EQ(table.property(i).offset, offsets[i]) << i;
  }
  EXPECT_EQ(table.persistent_width(), 5u);
  EXPECT_EQ(table.transient_width(), 7u);
  EXPECT_EQ(table.at("mode").max, 1);
  EXPECT_EQ(table.at("mode").initial[0], 1);
  EXPECT_EQ(table.at("rotation").initial[3], 1);
  EXPECT_EQ(table.at("active").initial[1], 0);
}

TEST(PropertyTable, FindsPropertiesIgnoringCaseAndUnderscores) {
  const PropertyTable table("thing", "/thing/<thing>", "",
                            {number("app_interval", "ms", 0, 0, 1, ""), number("app", "", 0, 0, 1, "")});
  for (const char* name : {"app_interval", "appInterval", "APPINTERVAL", "a_p_p_i_n_t_e_r_v_a_l_"}) {
    EXPECT_EQ(table.find(name), &table.property(0)) << name;
  }
  EXPECT_EQ(table.find("app"), &table.property(1));
  EXPECT_EQ(table.find("app_intervals"), nullptr);
  EXPECT_EQ(table.find(""), nullptr);
  EXPECT_EQ(table.property_names(), (std::vector<std::string_view>{"app_interval", "app"}));
}

TEST(PropertyTable, EachTypeHasAWidthAndAName) {
  const std::pair<PropertyType, std::pair<std::uint32_t, const char*>> expected[] = {
      {PropertyType::number, {1, "number"}},   {PropertyType::integer, {1, "integer"}},
      {PropertyType::boolean, {1, "boolean"}}, {PropertyType::choice, {1, "choice"}},
      {PropertyType::vec3, {3, "vec3"}},       {PropertyType::flags3, {3, "flags3"}},
      {PropertyType::quat, {4, "quat"}},       {PropertyType::none, {0, "action"}},
      {PropertyType::text, {0, "text"}}};
  for (const auto& [type, e] : expected) {
    EXPECT_EQ(width_of(type), e.first);
    EXPECT_EQ(type_name(type), e.second);
  }
  EXPECT_EQ(kind_name(PropertyKind::setting), "property");
  EXPECT_EQ(kind_name(PropertyKind::state), "state");
  EXPECT_EQ(kind_name(PropertyKind::readout), "readout");
  EXPECT_EQ(kind_name(PropertyKind::action), "action");
}

TEST(PropertyTable, OnlySettingsAndStatesAreWritable) {
  EXPECT_TRUE(number("a", "", 0, 0, 1, "").writable());
  EXPECT_TRUE(state(number("a", "", 0, 0, 1, "")).writable());
  EXPECT_FALSE(readout(number("a", "", 0, 0, 1, "")).writable());
  EXPECT_FALSE(action("a", 0, 0, "").writable());
  EXPECT_FALSE(action("a", 0, 0, "").stored());
}

TEST(Units, AreUniqueAndNamed) {
  EXPECT_TRUE(known_unit(""));
  EXPECT_TRUE(known_unit("N·m/rad"));
  EXPECT_FALSE(known_unit("Nm"));
  EXPECT_FALSE(known_unit("furlong"));
  for (const Unit& a : units()) {
    EXPECT_FALSE(a.meaning.empty()) << a.symbol;
    int same = 0;
    for (const Unit& b : units()) same += a.symbol == b.symbol ? 1 : 0;
    EXPECT_EQ(same, 1) << a.symbol;
  }
}

}  // namespace
}  // namespace limber
