// What a user reads: the text that is drawn for every property of all classes, at several sizes.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "panel/drawn_text.h"
#include "panel/rig.h"
#include "ui/panel/theme.h"
#include "ui/panel/widgets/number_slider.h"
#include "ui/panel/widgets/property_widget.h"

namespace limber::panel::test {
namespace {

// All classes with properties, and names that are alike and too long for every field.
constexpr const char* kAllClasses = R"(
params {
  { "rate", 0.5, min = 0, max = 2, unit = "Hz", doc = "How often." },
  { "the_length_of_the_upper_segment_of_the_left_leg", 0.5, min = 0, max = 20, unit = "m", doc = "Long." },
  { "the_length_of_the_lower_segment_of_the_left_leg", 0.5, min = 0, max = 20, unit = "m", doc = "Long." },
  { "mode", "slow", choices = { "slow", "as fast as the show allows it in the evening" }, doc = "Which." },
}
local joints = {}
for i, name in ipairs { "arm", "the_upper_segment_of_the_left_leg", "the_lower_segment_of_the_left_leg" } do
  local body = sim:add_body(name)
  local ball = name .. " ball"
  sim:add_sphere_shape(ball, 0.1)
  body:add_part("base", ball, { position = vec3(i, 0, 1), mass = 0 })
  body:add_part("tip", ball, { position = vec3(i, 0, 1.5), mass = 1 })
  joints[i] = body:add_joint("hinge", "base", "tip", { axis = vec3(0, 1, 0) })
  body:add_motor("hinge")
  body:add_behavior("force", "push_the_upper_segment_of_the_left_leg", { amp = 0 })
  body:add_behavior("force", "push_the_lower_segment_of_the_left_leg", { amp = 0 })
end
local tip = sim.bodies[1]:part("tip")
tip:add_imu("imu")
tip:add_range_finder("range finder")
tip:add_zone("zone")
tip:add_touch("touch")
for _, kind in ipairs { "alignment", "cohesion", "separation" } do
  sim:add_group_behavior(kind, "all_" .. kind)
end
for _, kind in ipairs { "force", "random_force", "random_rotation_target", "random_torque", "rotation_target",
                        "rotation_target_oscil", "speed",
                        "target_attraction", "torque", "volume" } do
  sim.bodies[1]:add_behavior(kind, "one_" .. kind)
end
sim:add_gear(joints[1], joints[2], 2)
sim:add_fixture("the_first_spot_on_the_left_side", { profile = "moving_spot", targets = tip })
sim:add_mocap("dancer", { source = "osc", joints = { "the_upper_segment_of_the_left_arm" } })
for _, kind in ipairs { "mocap_attraction", "mocap_body", "mocap_target" } do
  sim.bodies[1]:add_behavior(kind, "one_" .. kind)
end
sim.bodies[1]:add_tendon("cable", { points = { { "base", 0.2, 0, 0 }, { "tip" } } })
sim:add_route("from_the_length_of_the_upper_segment_to_the_tip", { from = "/scene/the_length_of_the_upper_segment_of_the_left_leg",
  to = "/physics/body/the_upper_segment_of_the_left_leg/part/tip/transparency" })
sim:add_route("waits", { from = "/physics/sim/time", to = "/physics/body/the_upper_segment_of_the_right_leg/part/tip/mass" })
)";

struct Size {
  double width, scale;
};
constexpr double kTall = 5000;  // all properties of an object are visible
constexpr Size kSizes[] = {{1600, 1}, {1280, 1}, {900, 1}, {1600, 2}, {3200, 2}};

// The paths of one object of each class.
std::vector<std::string> one_of_each_class(const TreeSnapshot& tree) {
  std::vector<std::string> paths;
  std::set<const PropertyTable*> classes;
  // from the end, because the first part is static
  for (auto node = static_cast<std::uint32_t>(tree.nodes().size()); --node > 0;) {
    const PropertyTable& table = *tree.nodes()[node].table;
    if (!table.properties().empty() && classes.insert(&table).second) paths.push_back(tree.path(node));
  }
  return paths;
}

// The object's node and its properties.
struct Object {
  std::string path;
  const PropertyTable* table;
};
Object object_at(const PanelFixture& fixture, const std::string& path) {
  const TreeSnapshot& tree = *fixture.gui->context().value_snapshot->tree;
  return {path, tree.nodes()[tree.find(path)->node].table};
}

void show(PanelFixture& fixture, const std::string& path) {
  fixture.gui->context().selected = path;
  fixture.sync();
}

double random_value(const Property& property, std::size_t i, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double low = std::max(property.low(i), -1e4);
  const double high = std::min(property.high(i), 1e4);
  double value = low + (high - low) * unit(random);
  if (random() % 3 == 0) value *= std::pow(10, -12 * unit(random));  // small ones, too
  value = std::clamp(value, property.low(i), property.high(i));
  return property.type == PropertyType::integer ? std::round(value) : value;
}

bool is_number(const Property& property) {
  return property.type == PropertyType::number || property.type == PropertyType::integer ||
         property.type == PropertyType::vec3 || property.type == PropertyType::quat;
}

// Sets all numbers of an object that can be set.
void set_randomly(PanelFixture& fixture, const Object& object, std::mt19937& random) {
  for (const Property& property : object.table->properties()) {
    const std::string path = object.path + "/" + property.name;
    // a longer step, or a history of another length, would be no fault but slow
    if (!property.writable() || !is_number(property) || property.name == "place") continue;
    std::vector<Arg> args;
    double sum = 0;
    for (std::size_t i = 0; i < property.width; i++) {
      args.push_back(Arg::of(random_value(property, i, random)));
      sum += args.back().number * args.back().number;
    }
    if (property.type == PropertyType::quat) {
      for (Arg& arg : args) arg = Arg::of(arg.number / std::sqrt(sum));
    }
    fixture.gui->context().send(path, std::move(args));
  }
  fixture.sync();
}

// Half of the last digit shown: 0.005 for "3.14".
double half_digit(const std::string& text) {
  const std::size_t e = text.find('e');
  const std::string mantissa = text.substr(0, e);
  const std::size_t point = mantissa.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  return 0.5 * std::pow(10.0, (e == std::string::npos ? 0 : std::atoi(text.c_str() + e + 1)) - decimals);
}

// Reads a number of at least two digits that is drawn in a widget; "0" for values below the noise.
void expect_number(const std::string& text, double value, double noise) {
  char* end = nullptr;
  const double parsed = std::strtod(text.c_str(), &end);
  ASSERT_FALSE(text.empty());
  ASSERT_EQ(*end, 0) << "'" << text << "' is no number, of " << value;
  if (text == "0" || std::abs(value) < noise) {
    EXPECT_LT(std::abs(value), noise) << "shows " << text;
    EXPECT_EQ(text, "0") << value;
    return;
  }
  EXPECT_LE(std::abs(parsed - value), half_digit(text) * (1 + 1e-6)) << "'" << text << "' of " << value;
  EXPECT_LE(half_digit(text), std::abs(value) * 0.51) << "'" << text << "' of " << value << " has no digit";
}

// Values below it show 0: a millionth of a linear range, or of a vector's largest component.
double noise_of(const Property& property, std::size_t i, const std::vector<double>& values) {
  const SliderRange range{property.low(i), property.high(i), property.initial[i], 0, false};
  const bool linear =
      range.bounded() && std::abs(range.position_of(range.min + 0.3 * (range.max - range.min)) - 0.3) < 1e-9;
  double noise = linear ? 1e-6 * (range.max - range.min) : 2.3e-16;
  if (property.type != PropertyType::vec3 || property.own_axis || property.euler) return noise;
  for (const double v : values) noise = std::max(noise, 1e-6 * std::abs(v));
  return noise;
}

void expect_property(PanelFixture& fixture, const DrawnText& drawn, const std::string& path, const Property& property) {
  SCOPED_TRACE(path);
  std::vector<double> values;
  for (std::size_t i = 0; i < property.width; i++) values.push_back(fixture.read(path, i));
  for (std::size_t i = 0; i < property.width; i++) {
    const std::string name = property.width > 1 ? path + "/" + std::to_string(i) : path;
    ASSERT_TRUE(fixture.is_visible(name)) << name;
    const std::string text = drawn.in(fixture.rect_of(name));
    if (is_number(property)) {
      expect_number(text, values[i], noise_of(property, i, values));
    } else if (property.type == PropertyType::choice) {
      const std::string& label = property.choices[static_cast<std::size_t>(values[0])];
      EXPECT_TRUE(text == label || (text.find("…") != text.npos && text.substr(0, 3) == label.substr(0, 3))) << text;
    } else if (!property.writable()) {
      EXPECT_EQ(text, values[i] != 0 ? "yes" : "no");
    }
  }
}

class Legibility : public ::testing::TestWithParam<Size> {};

TEST_P(Legibility, NumbersEqualTheWorld) {
  const auto [width, scale] = GetParam();
  PanelFixture fixture(kAllClasses, width, kTall * scale);
  fixture.scale = scale;
  fixture.show.ticks(3);
  fixture.sync();
  std::mt19937 random(5);
  std::set<std::string> covered;
  for (const std::string& path : one_of_each_class(*fixture.gui->context().value_snapshot->tree)) {
    const Object object = object_at(fixture, path);
    set_randomly(fixture, object, random);
    show(fixture, path);
    const DrawnText drawn;
    for (const Property& property : object.table->properties()) {
      if (property.kind == PropertyKind::action || property.type == PropertyType::text) continue;
      expect_property(fixture, drawn, path + "/" + property.name, property);
      covered.insert(object.table->path() + "/" + property.name);
    }
  }
  std::ifstream list(LIMBER_SOURCE_DIR "/tests/golden/addresses.txt");
  std::string line;
  std::getline(list, line);
  int missing = 0;
  while (std::getline(list, line)) {
    std::istringstream columns(line);
    std::string address, legacy, kind, type;
    std::getline(columns, address, '\t');
    std::getline(columns, legacy, '\t');
    std::getline(columns, kind, '\t');
    std::getline(columns, type, '\t');
    const bool value = (kind == "property" || kind == "state" || kind == "readout") && type != "text";
    if (value && !covered.contains(address)) {
      ADD_FAILURE() << address << " was not read";
      if (++missing > 20) break;
    }
  }
}

std::string without_blanks(std::string text) {
  std::erase(text, ' ');
  return text;
}

void expect_nothing_is_cut() {
  for (const std::string& piece : DrawnText().cut()) ADD_FAILURE() << "cut: '" << piece << "'";
}

TEST_P(Legibility, NamesOfPropertiesAreComplete) {
  const auto [width, scale] = GetParam();
  PanelFixture fixture(kAllClasses, width, kTall * scale);
  fixture.scale = scale;
  fixture.sync();
  for (const std::string& path : one_of_each_class(*fixture.gui->context().value_snapshot->tree)) {
    const Object object = object_at(fixture, path);
    show(fixture, path);
    const DrawnText drawn;
    std::set<std::string> texts;
    for (const Property& property : object.table->properties()) {
      if (path == "/physics/sim" && property.kind == PropertyKind::action) continue;
      const std::string address = path + "/" + property.name;
      SCOPED_TRACE(address);
      const bool action = property.kind == PropertyKind::action;
      const std::string text = without_blanks(drawn.in(fixture.rect_of(action ? address : "name:" + address)));
      EXPECT_TRUE(text.starts_with(without_blanks(property_label(property)))) << text;
      EXPECT_TRUE(texts.insert(text).second) << text << " appears twice";
      if (!action && property.unit != "hsb") {
        const PanelRect name = fixture.rect_of("name:" + address);
        EXPECT_NE(drawn.in({name.x, name.y, 440 * scale, name.height}).find(property.unit), std::string::npos);
      }
    }
    expect_nothing_is_cut();
  }
}

TEST_P(Legibility, MarksCoverNoDigits) {
  const auto [width, scale] = GetParam();
  PanelFixture fixture(kAllClasses, width, kTall * scale);
  fixture.scale = scale;
  std::mt19937 random(6);
  const unsigned accent = packed_color(ThemeColor::accent);
  std::size_t marks = 0;
  for (const std::string& path : one_of_each_class(*fixture.gui->context().value_snapshot->tree)) {
    set_randomly(fixture, object_at(fixture, path), random);
    show(fixture, path);
    const DrawnText drawn;
    for (const DrawnBox& box : drawn.boxes()) {
      if (box.color != accent) continue;
      marks++;
      for (const DrawnGlyph& g : drawn.glyphs()) {
        const bool covers = box.left < g.right && box.right > g.left && box.top < g.bottom && box.bottom > g.top;
        ASSERT_FALSE(covers) << path << ": '" << drawn.in({box.left - 60, box.top, 120, box.bottom - box.top}) << "'";
      }
    }
  }
  EXPECT_GT(marks, 100u);
}

// Returns the texts of all visible widgets whose name begins with the prefix, by the part of the name before the last
// slash.
std::map<std::string, std::vector<std::string>> texts_of(const PanelFixture& fixture, const std::string& prefix) {
  const DrawnText drawn;
  std::map<std::string, std::vector<std::string>> texts;
  for (const NamedWidget& widget : fixture.gui->names().all()) {
    if (widget.name.starts_with(prefix) && !widget.visible.empty())
      texts[widget.name.substr(0, widget.name.rfind('/'))].push_back(drawn.in(widget.visible));
  }
  return texts;
}

void expect_different(const std::map<std::string, std::vector<std::string>>& texts, std::size_t at_least) {
  std::size_t count = 0;
  for (const auto& [parent, members] : texts) {
    std::set<std::string> different;
    for (const std::string& text : members) {
      EXPECT_FALSE(text.empty()) << parent;
      EXPECT_TRUE(different.insert(text).second) << parent << ": '" << text << "' appears twice";
      count++;
    }
  }
  EXPECT_GE(count, at_least);
}

TEST_P(Legibility, ObjectsAndBehaviorsHaveDifferentNames) {
  const auto [width, scale] = GetParam();
  PanelFixture fixture(kAllClasses, width, kTall * scale);
  fixture.scale = scale;
  fixture.sync();
  if (fixture.is_visible("tab:scene")) fixture.click("tab:scene");
  fixture.gui->context().select("/physics/body/arm/behavior/push_the_upper_segment_of_the_left_leg");
  fixture.frames(3);
  expect_different(texts_of(fixture, "tree:"), 20);
  expect_nothing_is_cut();
  fixture.gui->context().selected.clear();
  fixture.sync();
  if (fixture.is_visible("tab:behaviors")) fixture.click("tab:behaviors");
  fixture.frames(3);
  expect_different(texts_of(fixture, "behavior:"), 14);
  expect_nothing_is_cut();
}

TEST_P(Legibility, NothingIsCutInTheOtherPanels) {
  const auto [width, scale] = GetParam();
  PanelFixture fixture(kAllClasses, width, 900 * scale);
  fixture.scale = scale;
  fixture.gui->context().plots = {"/scene/the_length_of_the_upper_segment_of_the_left_leg",
                                  "/physics/body/the_upper_segment_of_the_left_leg/part/tip/linear_velocity"};
  fixture.show.link.counters.received = 123456789012345;
  fixture.show.link.counters.sent = 987654321098765;
  log_error(
      "scene.lua:12: an error whose text is longer than any panel is wide, so that it has to be wrapped somewhere");
  for (const char* const tab : {"tab:errors", "tab:osc", "tab:performance", "tab:plots", "tab:routes", "tab:console"}) {
    if (fixture.is_visible(tab)) fixture.click(tab);
    fixture.show.link.message_log.add(
        true, "127.0.0.1",
        engine::test::message("/physics/body/the_upper_segment_of_the_left_leg/part/tip/position", 0.123456789));
    fixture.show.ticks(1);
    fixture.move(0, 0);
    fixture.sync();
    SCOPED_TRACE(tab);
    expect_nothing_is_cut();
  }
  for (const char* const lamp : {"IN", "OUT", "LUA"})
    EXPECT_EQ(DrawnText().in(fixture.rect_of(std::string("status.") + lamp)), lamp);
}

// Addresses in the results of a search are complete.
TEST_P(Legibility, AddressesOfSearchResultsAreComplete) {
  const auto [width, scale] = GetParam();
  PanelFixture fixture(kAllClasses, width, kTall * scale);
  fixture.scale = scale;
  fixture.sync();
  fixture.click("parameters.search");
  fixture.type("segment max");
  fixture.frames(5);
  std::size_t results = 0;
  const DrawnText drawn;
  for (const NamedWidget& widget : fixture.gui->names().all()) {
    if (!widget.name.starts_with("name:/") || widget.visible.empty()) continue;
    const std::string text = without_blanks(drawn.in(widget.visible));
    EXPECT_TRUE(text.starts_with(without_blanks(widget.name.substr(5)))) << text;
    results++;
  }
  EXPECT_GT(results, 3u);
  expect_nothing_is_cut();
}

TEST(LegibilityOfText, StatusHasSingularAndPlural) {
  for (const auto& [count, expected] : {std::pair(1, "1 body"), {2, "2 bodies"}}) {
    std::string scene;
    for (int i = 0; i < count; i++) scene += "sim:add_body('b" + std::to_string(i) + "')\n";
    PanelFixture fixture(scene, 1900, 900);
    fixture.frames(2);
    const std::string text = DrawnText().in(fixture.rect_of("status.text"));
    EXPECT_NE(text.find(expected), std::string::npos) << text;
    EXPECT_NE(text.find("0 parts"), std::string::npos) << text;
  }
}

TEST(LegibilityOfText, FiguresHaveTooltips) {
  PanelFixture fixture;
  for (const char* const name : {"Tick", "Max", "Budget", "Speed", "Commands", "Scripts", "Behaviors", "Callbacks",
                                 "Physics", "Readouts", "Snapshot", "GC", "Dropped", "Queue"}) {
    const std::string widget = std::string("performance.") + name;
    if (!fixture.is_visible(widget)) fixture.scroll("performance.Tick", -20);
    const std::size_t before = DrawnText().glyphs().size();
    fixture.point(widget);
    EXPECT_GT(DrawnText().glyphs().size(), before + 20) << name;
    fixture.move(0, 0);
    fixture.frames(3);
  }
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Sizes, Legibility, ::testing::ValuesIn(kSizes));

}  // namespace limber::panel::test
