// The panel as a whole: hides, helps, grows, registers all its files, says what fonts are missing.
#include "gui/gui.h"

#include <filesystem>
#include <set>

#include <imgui.h>

#include "gui/rig.h"

namespace limber::gui_test {
namespace {

TEST(Gui, EveryPanelFileRegistersItself) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LIMBER_SOURCE_DIR) + "/src/gui")) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("panel_") && name.ends_with(".cpp")) files.insert(name.substr(6, name.size() - 10));
  }
  std::set<std::string> kinds;
  for (const PanelKind& kind : panel_kinds()) kinds.insert(std::string(kind.name));
  EXPECT_EQ(kinds, files);
}

TEST(Gui, F1HidesAndF2Helps) {
  PanelRig rig;
  EXPECT_TRUE(rig.sees("transport.play"));
  rig.key(GuiKey::f1);
  rig.frames(2);
  EXPECT_FALSE(rig.sees("transport.play"));
  EXPECT_FALSE(rig.gui->wants_mouse());
  rig.key(GuiKey::f1);
  rig.frames(2);
  EXPECT_TRUE(rig.sees("transport.play"));
  rig.key(GuiKey::f2);
  EXPECT_TRUE(rig.gui->desk().help);
}

// what is drawn last lies above
std::string drawn_last() {
  const ImDrawData* const drawn = ImGui::GetDrawData();
  return drawn->CmdLists[drawn->CmdListsCount - 1]->_OwnerName;
}

TEST(Gui, HelpAndNoticesLieOverThePanels) {
  PanelRig rig(kScene, 900, 600);
  rig.key(GuiKey::f2);
  rig.frames(2);
  EXPECT_EQ(drawn_last(), "##help");
  rig.key(GuiKey::f2);
  rig.key(GuiKey::z, {true, false, false});
  rig.frames(2);
  EXPECT_EQ(drawn_last(), "##notice");
}

TEST(Gui, TextGrowsFrom12To28) {
  PanelRig rig;
  constexpr KeyMods kCtrl{true, false, false};
  const double before = rig.where("transport.play").height;
  for (int i = 0; i < 20; i++) rig.key(GuiKey::equal, kCtrl);
  EXPECT_EQ(rig.gui->settings().text_size, 28);
  EXPECT_NEAR(rig.where("transport.play").height / before, 28.0 / 16, 0.1);
  for (int i = 0; i < 30; i++) rig.key(GuiKey::minus, kCtrl);
  EXPECT_EQ(rig.gui->settings().text_size, 12);
}

TEST(Gui, FavouritesStayTogether) {
  PanelRig rig;
  rig.click("star:/scene/rate");
  rig.click("star:/physics/sim/gravity");
  rig.click("parameters.favourites");
  EXPECT_TRUE(rig.sees("/scene/rate"));
  EXPECT_TRUE(rig.sees("/physics/sim/gravity/2"));
  EXPECT_FALSE(rig.sees("/scene/lit"));
  rig.drag("/scene/rate", 0.9);
  EXPECT_GT(rig.read("/scene/rate"), 1.5);
  rig.click("star:/scene/rate");
  EXPECT_FALSE(rig.sees("/scene/rate"));
}

TEST(Gui, ASearchLooksThroughEverything) {
  PanelRig rig;
  rig.key(GuiKey::f, {true, false, false});
  rig.type("LEG tip mass");
  rig.frames(5);
  ASSERT_TRUE(rig.sees("/physics/body/leg/part/tip/mass"));
  EXPECT_FALSE(rig.sees("/physics/body/arm/part/tip/mass"));
}

TEST(Gui, EverythingIsReachedByKeys) {
  PanelRig rig;
  rig.click("parameters.search");
  rig.type("scene rate");
  rig.frames(4);
  rig.key(GuiKey::enter);
  rig.key(GuiKey::down);
  rig.key(GuiKey::down);
  rig.key(GuiKey::enter);
  rig.key(GuiKey::a, {true, false, false});
  rig.type("1.25");
  rig.key(GuiKey::enter);
  EXPECT_EQ(rig.read("/scene/rate"), 1.25);
}

TEST(Gui, OnlyTheWindowsActionsAreHandedOn) {
  PanelRig rig;
  rig.key(GuiKey::f11);
  rig.key(GuiKey::home);
  rig.key(GuiKey::f2);
  EXPECT_EQ(rig.gui->take_actions(), (std::vector<HotkeyAction>{HotkeyAction::full_screen, HotkeyAction::home_view}));
  EXPECT_TRUE(rig.gui->take_actions().empty());
}

TEST(Gui, AWindowOfOnePixelIsAWindow) {
  PanelRig rig;
  rig.resize(1, 1);
  EXPECT_TRUE(rig.gui->names().all().empty());
  rig.resize(1600, 900);
  EXPECT_TRUE(rig.sees("transport.play"));
}

TEST(Gui, WhatFontsAreMissingIsSaid) {
  const FontFiles none = find_fonts("/nowhere");
  ASSERT_EQ(none.said.size(), 2u);
  EXPECT_NE(none.said[0].find("apt-get install fonts-inter"), std::string::npos);
  EXPECT_NE(none.said[1].find("apt-get install fonts-jetbrains-mono"), std::string::npos);
  EngineLink link;
  GuiOptions options = PanelRig::headless();
  options.font_root = "/nowhere";
  Gui gui(link, std::move(options));
  gui.frame({800, 600, 1, 0.1});
  EXPECT_NE(gui.desk().fonts.words, nullptr) << "the one inside stands in";
}

TEST(Gui, SeveralLiveSideBySide) {
  PanelRig one;
  PanelRig two;
  one.key(GuiKey::f1);
  two.frames(2);
  EXPECT_TRUE(one.gui->settings().hidden);
  EXPECT_FALSE(two.gui->settings().hidden);
}

}  // namespace
}  // namespace limber::gui_test
