// Tables: how rows are laid out, found and described; the closed list of units.
#include "params/table.h"

#include <gtest/gtest.h>

#include "params/units.h"

namespace limber {
namespace {

using namespace rows;

TEST(Table, LaysStoredRowsOutInTwoBlocks) {
  const Table table("thing", "/thing/<thing>", "",
                    {number("mass", "kg", 1, 0, 10, ""), live(state(vec3("position", "m", {0, 0, 0}, -1, 1, ""))),
                     flags3("active", {true, false, true}, ""), live(state(quat("rotation", ""))),
                     action("kick", 0, 1, ""), choice("mode", {"off", "on"}, 1, "")});
  const std::uint32_t offsets[] = {0, 0, 1, 3, 0, 4};
  const std::uint32_t widths[] = {1, 3, 3, 4, 0, 1};
  for (std::uint32_t i = 0; i < 6; i++) {
    EXPECT_EQ(table.row(i).index, i);
    EXPECT_EQ(table.row(i).width, widths[i]) << i;
    EXPECT_EQ(table.row(i).offset, offsets[i]) << i;
  }
  EXPECT_EQ(table.kept_width(), 5u);
  EXPECT_EQ(table.live_width(), 7u);
  EXPECT_EQ(table.at("mode").max, 1);
  EXPECT_EQ(table.at("mode").initial[0], 1);
  EXPECT_EQ(table.at("rotation").initial[3], 1);
  EXPECT_EQ(table.at("active").initial[1], 0);
}

TEST(Table, FindsRowsByTheOneNamingRule) {
  const Table table("thing", "/thing/<thing>", "",
                    {number("app_interval", "ms", 0, 0, 1, ""), number("app", "", 0, 0, 1, "")});
  for (const char* name : {"app_interval", "appInterval", "APPINTERVAL", "a_p_p_i_n_t_e_r_v_a_l_"}) {
    EXPECT_EQ(table.find(name), &table.row(0)) << name;
  }
  EXPECT_EQ(table.find("app"), &table.row(1));
  EXPECT_EQ(table.find("app_intervals"), nullptr);
  EXPECT_EQ(table.find(""), nullptr);
  EXPECT_EQ(table.row_names(), (std::vector<std::string_view>{"app_interval", "app"}));
}

TEST(Table, EachTypeHasAWidthAndAName) {
  const std::pair<RowType, std::pair<std::uint32_t, const char*>> expected[] = {
      {RowType::number, {1, "number"}}, {RowType::integer, {1, "integer"}}, {RowType::boolean, {1, "boolean"}},
      {RowType::choice, {1, "choice"}}, {RowType::vec3, {3, "vec3"}},       {RowType::flags3, {3, "flags3"}},
      {RowType::quat, {4, "quat"}},     {RowType::none, {0, "action"}},     {RowType::text, {0, "text"}}};
  for (const auto& [type, e] : expected) {
    EXPECT_EQ(width_of(type), e.first);
    EXPECT_EQ(type_name(type), e.second);
  }
  EXPECT_EQ(kind_name(RowKind::property), "property");
  EXPECT_EQ(kind_name(RowKind::state), "state");
  EXPECT_EQ(kind_name(RowKind::readout), "readout");
  EXPECT_EQ(kind_name(RowKind::action), "action");
}

TEST(Table, OnlyPropertiesAndStatesAreWritable) {
  EXPECT_TRUE(number("a", "", 0, 0, 1, "").writable());
  EXPECT_TRUE(state(number("a", "", 0, 0, 1, "")).writable());
  EXPECT_FALSE(readout(number("a", "", 0, 0, 1, "")).writable());
  EXPECT_FALSE(action("a", 0, 0, "").writable());
  EXPECT_FALSE(action("a", 0, 0, "").stored());
}

TEST(Units, AreAClosedListWithoutDoubles) {
  EXPECT_TRUE(known_unit(""));
  EXPECT_TRUE(known_unit("N·m/rad"));
  EXPECT_FALSE(known_unit("Nm"));
  EXPECT_FALSE(known_unit("furlong"));
  for (const Unit& a : units()) {
    EXPECT_FALSE(a.means.empty()) << a.symbol;
    int same = 0;
    for (const Unit& b : units()) same += a.symbol == b.symbol ? 1 : 0;
    EXPECT_EQ(same, 1) << a.symbol;
  }
}

}  // namespace
}  // namespace limber
