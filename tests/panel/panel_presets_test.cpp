// Preset slots: store, recall, morph, and the interpolating index.
#include <string>
#include <utility>
#include <vector>

#include "engine/presets/presets.h"
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

void at_once(PanelFixture& fixture) { fixture.gui->context().settings.morph_seconds = 0; }

TEST(PanelPresets, StoreRecallAndInterpolate) {
  PanelFixture fixture;
  at_once(fixture);
  fixture.drag("/scene/rate", 0.25);
  const double low = fixture.read("/scene/rate");
  fixture.click("preset.new");
  EXPECT_EQ(fixture.read("/preset/count"), 1);
  fixture.drag("/scene/rate", 0.75);
  const double high = fixture.read("/scene/rate");
  fixture.click("preset.new");
  EXPECT_EQ(fixture.read("/preset/count"), 2);
  fixture.click("preset.1");
  EXPECT_EQ(fixture.read("/scene/rate"), low);
  fixture.key(GuiKey::digit_2);
  EXPECT_EQ(fixture.read("/scene/rate"), high) << "by its key";
  fixture.drag("preset.index", 0.5);
  EXPECT_NEAR(fixture.read("/scene/rate"), (low + high) / 2, 0.06) << "half-way between the two";
  fixture.click("preset.1", 1);
  fixture.click("menu:preset_delete");
  EXPECT_EQ(fixture.read("/preset/count"), 1);
}

TEST(PanelPresets, CtrlClickOverwrites) {
  PanelFixture fixture;
  at_once(fixture);
  fixture.click("preset.new");
  fixture.drag("/scene/rate", 0.9);
  const double now = fixture.read("/scene/rate");
  fixture.click("preset.1", 0, KeyMods{true, false, false});
  fixture.drag("/scene/rate", 0.1);
  fixture.click("preset.1");
  EXPECT_EQ(fixture.read("/scene/rate"), now);
  EXPECT_EQ(fixture.read("/preset/count"), 1);
}

TEST(PanelPresets, MorphHasConfiguredDuration) {
  PanelFixture fixture;
  fixture.click("preset.new");
  fixture.drag("/scene/rate", 1);
  fixture.gui->context().settings.morph_seconds = 1;
  fixture.click("preset.easing");
  fixture.click("preset.easing=linear");
  fixture.click("preset.1");
  fixture.show.ticks(30);  // half a second
  EXPECT_NEAR(fixture.read("/scene/rate"), 1.25, 0.05) << "half-way from 2 to 0.5";
  fixture.show.ticks(40);
  EXPECT_EQ(fixture.read("/scene/rate"), 0.5);
}

// Stores presets of these names, with different values of the parameter.
void store_presets(PanelFixture& fixture, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); i++) {
    fixture.show.send("/scene/rate", 2 * static_cast<double>(i + 1) / static_cast<double>(names.size()));
    fixture.show.send("/preset/store", names[i]);
    fixture.show.engine.idle();
  }
  fixture.sync();
}

std::vector<std::string> preset_names(PanelFixture& fixture) {
  std::vector<std::string> names;
  for (const auto& preset : fixture.show.engine.presets().list()) names.push_back(preset->name);
  return names;
}

TEST(PanelPresets, RightClickOpensOneMenu) {
  PanelFixture fixture;
  store_presets(fixture, {"dusk", "dawn"});
  const std::vector<std::string> entries{"menu:preset_name", "menu:preset_rename", "menu:preset_store",
                                         "menu:preset_delete"};
  fixture.click("preset.2", 1);
  EXPECT_EQ(fixture.names_with("menu:"), entries);
  fixture.key(GuiKey::escape);
  EXPECT_TRUE(fixture.names_with("menu:").empty());
  fixture.click("preset.list");
  fixture.click("preset.list.1", 1);
  EXPECT_EQ(fixture.names_with("menu:"), entries) << "in the list";
}

TEST(PanelPresets, ShowsNames) {
  PanelFixture fixture;
  store_presets(fixture, {"a", "a long name for a preset"});
  EXPECT_GT(fixture.rect_of("preset.2").width, fixture.rect_of("preset.1").width);
  fixture.click("preset.list");
  EXPECT_TRUE(fixture.is_visible("preset.list.1"));
  EXPECT_TRUE(fixture.is_visible("preset.list.2"));
  EXPECT_TRUE(fixture.is_visible("preset.index.label"));
}

TEST(PanelPresets, MenuRenames) {
  PanelFixture fixture;
  store_presets(fixture, {"dusk", "dawn"});
  fixture.click("preset.2", 1);
  fixture.click("menu:preset_name");
  fixture.key(GuiKey::a, kCtrl);
  fixture.type("sun & sea");
  fixture.key(GuiKey::enter);
  EXPECT_EQ(preset_names(fixture), (std::vector<std::string>{"dusk", "sun & sea"}));
  EXPECT_TRUE(fixture.names_with("menu:").empty()) << "the menu closes";
  fixture.click("preset.1", 1);
  fixture.click("menu:preset_name");
  fixture.key(GuiKey::a, kCtrl);
  fixture.type("moon");
  fixture.click("menu:preset_rename");
  EXPECT_EQ(preset_names(fixture), (std::vector<std::string>{"moon", "sun & sea"}));
  fixture.click("preset.1", 1);
  fixture.click("menu:preset_rename");
  EXPECT_FALSE(fixture.is_visible("rejection")) << "the same name";
}

TEST(PanelPresets, ReachesMoreThanEight) {
  for (const auto& [width, height] : {std::pair(1600, 900), {1280, 720}, {800, 450}}) {
    SCOPED_TRACE(width);
    PanelFixture fixture(kScene, width, height);
    at_once(fixture);
    std::vector<std::string> names;
    for (int i = 1; i <= 20; i++) names.push_back("preset number " + std::to_string(i));
    store_presets(fixture, names);
    EXPECT_TRUE(fixture.is_visible("preset.1"));
    EXPECT_FALSE(fixture.is_visible("preset.20"));
    for (int i = 0; i < 25 && !fixture.is_visible("preset.20"); i++) fixture.click("preset.later");
    fixture.click("preset.20");
    EXPECT_EQ(fixture.read("/scene/rate"), 2);
    fixture.scroll("preset.20", 25);
    for (int i = 0; i < 25 && !fixture.is_visible("preset.1"); i++) fixture.scroll("preset.earlier", 1);
    fixture.click("preset.1");
    EXPECT_NEAR(fixture.read("/scene/rate"), 0.1, 1e-9);
    fixture.click("preset.list");
    fixture.click("preset.list.10");
    EXPECT_NEAR(fixture.read("/scene/rate"), 1, 1e-9);
    EXPECT_FALSE(fixture.is_visible("preset.list.10")) << "the list closes";
  }
}

// Nothing in the top panel covers anything else.
TEST(PanelPresets, StripDoesNotCoverTheStatus) {
  for (const auto& [width, height] : {std::pair(1600, 900), {1280, 720}, {800, 450}}) {
    SCOPED_TRACE(width);
    PanelFixture fixture(kScene, width, height);
    store_presets(fixture, {"one", "two", "a long name for a preset", "another long name for a preset", "five", "six",
                            "seven", "eight", "nine", "ten", "eleven", "twelve"});
    const PanelRect plus = fixture.rect_of("preset.new");
    const PanelRect status = fixture.rect_of("status.text");
    const PanelRect morph = fixture.rect_of("preset.seconds");
    const PanelRect index = fixture.rect_of("preset.index");
    EXPECT_TRUE(plus.x + plus.width < status.x || plus.y > status.y + status.height);
    EXPECT_TRUE(plus.x + plus.width < morph.x || morph.y > plus.y + plus.height);
    EXPECT_LT(index.x + index.width, width - 8);
  }
}

TEST(PanelPresets, KeyOfEmptySlotDoesNothing) {
  PanelFixture fixture;
  fixture.key(GuiKey::digit_5);
  EXPECT_EQ(fixture.read("/preset/count"), 0);
  EXPECT_NE(fixture.gui->context().notice.text.find("Preset 5 not found"), std::string::npos);
}

}  // namespace
}  // namespace limber::panel::test
