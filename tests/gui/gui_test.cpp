// The panel as a whole: hides, helps, grows, registers all its files, says what fonts are missing.
#include "gui/gui.h"

#include <algorithm>
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

TEST(Gui, TheWholeHelpIsSeenInASmallWindow) {
  for (const auto& [width, height] : {std::pair(800.0, 450.0), {1600.0, 900.0}}) {
    PanelRig rig(kScene, width, height);
    rig.key(GuiKey::f2);
    rig.frames(3);
    const PanelRect first = rig.where("help:panic");
    const PanelRect last = rig.where("help:Tab, arrows, Enter");
    EXPECT_GT(last.y, first.y);
    EXPECT_LT(last.y + last.height, height - 8) << width;
    EXPECT_GE(last.height, 11) << "and can be read";
  }
}

TEST(Gui, AClickInTheHelpChoosesAnotherKey) {
  PanelRig rig;
  rig.key(GuiKey::f2);
  rig.frames(3);
  const auto choose = [&](GuiKey key, KeyMods mods = {}) {
    rig.click("help:panic");
    rig.key(key, mods);
    rig.frames(2);
    return rig.gui->settings().keys;
  };
  EXPECT_EQ(choose(GuiKey::f9), (KeyChoices{{"panic", "F9"}}));
  EXPECT_EQ(choose(GuiKey::r, kCtrl), (KeyChoices{{"panic", "F9"}})) << "that one is taken";
  EXPECT_EQ(choose(GuiKey::escape), (KeyChoices{{"panic", "F9"}}));
  rig.key(GuiKey::f2);
  rig.key(GuiKey::f12);
  rig.heard();
  EXPECT_FALSE(rig.gui->desk().panicked());
  rig.key(GuiKey::f9);
  rig.heard();
  EXPECT_TRUE(rig.gui->desk().panicked());
  rig.key(GuiKey::f2);
  rig.frames(3);
  EXPECT_EQ(choose(GuiKey::erase), KeyChoices());
  rig.click("help:recall");
  rig.key(GuiKey::f9);
  EXPECT_EQ(rig.gui->settings().keys, KeyChoices()) << "eight keys";
}

TEST(Gui, KeysOfTheSettingsAct) {
  GuiOptions options = PanelRig::headless();
  options.settings.keys = {{"help", "Ctrl+H"}, {"nothing", "F9"}};
  EngineLink link;
  const std::uint64_t before = log_newest();
  Gui gui(link, options);
  EXPECT_TRUE(std::ranges::any_of(log_since(before), [](const LogLine& line) {
    return line.text.find("key 'F9' for 'nothing'") != line.text.npos;
  }));
  gui.push({.kind = InputEvent::Kind::key, .key = GuiKey::h, .down = true, .mods = kCtrl});
  gui.frame({800, 600, 1, 0.1});
  EXPECT_TRUE(gui.desk().help);
}

TEST(Gui, F3ShowsTheDebugPicture) {
  PanelRig rig;
  rig.key(GuiKey::f3);
  EXPECT_EQ(rig.read("/visuals/look/overlay"), 1);
  rig.key(GuiKey::f3);
  EXPECT_EQ(rig.read("/visuals/look/overlay"), 0);
}

TEST(Gui, NineViewsAreKeptAndTakenAgain) {
  PanelRig rig;
  const auto look = [&](double x) {
    for (const char* row : {"/visuals/camera/eye", "/visuals/camera/target", "/visuals/camera/eye"})
      rig.show.send(row, x, std::string_view(row).ends_with("eye") ? -5.0 : 1.0, 2.0);
    rig.heard();
  };
  look(3);
  rig.key(GuiKey::digit_1, kCtrlShift);
  look(7);
  rig.key(GuiKey::digit_9, kCtrlShift);
  look(11);
  rig.key(GuiKey::digit_5, kCtrl);
  EXPECT_NEAR(rig.read("/visuals/camera/eye"), 11, 1e-6) << "there is none";
  EXPECT_NE(rig.gui->desk().notice.find("there is no view 5"), std::string::npos) << rig.gui->desk().notice;
  for (const auto& [key, x] : {std::pair(GuiKey::digit_1, 3.0), {GuiKey::digit_9, 7.0}}) {
    rig.key(key, kCtrl);
    EXPECT_NEAR(rig.read("/visuals/camera/eye", 0), x, 1e-6);
    EXPECT_NEAR(rig.read("/visuals/camera/eye", 1), -5, 1e-6);
    EXPECT_NEAR(rig.read("/visuals/camera/target", 0), x, 1e-6);
    EXPECT_NEAR(rig.read("/visuals/camera/target", 1), 1, 1e-6);
  }
  EXPECT_EQ(rig.gui->take_actions().back(), HotkeyAction::go_to_view) << "what is followed is followed no more";
}

TEST(Gui, TheChosenStyleIsRememberedUnlessTheSceneHasItsOwn) {
  PanelRig rig;
  rig.click("parameters.search");
  rig.type("look style");
  rig.click("/visuals/look/style");
  rig.click("/visuals/look/style=studio");
  EXPECT_EQ(rig.read("/visuals/look/style"), 1);
  const PanelSettings settings = rig.gui->settings();
  EXPECT_EQ(settings.style, "studio");
  for (const auto& [scene, style] :
       {std::pair(std::string(kScene), 1.0), {std::string(kScene) + "visuals.look.style = \"stage\"\n", 0.0}}) {
    PanelRig next(scene);
    GuiOptions options = PanelRig::headless();
    options.settings = settings;
    next.gui = std::make_unique<Gui>(next.show.link, std::move(options));
    next.heard();
    next.heard();
    EXPECT_EQ(next.read("/visuals/look/style"), style);
  }
}

TEST(Gui, TextGrowsFrom12To28) {
  PanelRig rig;
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

// a frame's corner stands for all letters that the two lack: JetBrains Mono has it, but it is not taken of that
TEST(Gui, LettersOfNamesComeFromAThirdFont) {
  const std::string scene = std::string(kScene) + "sim:add_body('\u250crm \u8155')\n";
  PanelRig rig(scene);
  const std::filesystem::path root = rig.folder() / "fonts_of_a_test";
  const std::filesystem::path droid = root / "usr/share/fonts/truetype/droid";
  std::filesystem::create_directories(droid);
  std::filesystem::copy_file("/usr/share/fonts/truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
                             droid / "DroidSansFallbackFull.ttf");
  GuiOptions options = PanelRig::headless();
  options.font_root = root.string();
  rig.gui = std::make_unique<Gui>(rig.show.link, std::move(options));
  rig.heard();
  rig.frames(2);
  for (const ImFont* font : {rig.gui->desk().fonts.words, rig.gui->desk().fonts.code}) {
    EXPECT_NE(font->FindGlyphNoFallback(0x250c), nullptr);
    EXPECT_EQ(font->FindGlyphNoFallback(0x2510), nullptr) << "what no name has is not taken";
  }
  std::filesystem::remove_all(root);
  const std::uint64_t said = log_count(LogLevel::warning);
  GuiOptions none = PanelRig::headless();
  none.font_root = "/nowhere";
  rig.gui = std::make_unique<Gui>(rig.show.link, std::move(none));
  rig.heard();
  rig.frames(2);
  EXPECT_EQ(log_count(LogLevel::warning), said + 3) << "two fonts are missing, and one for these letters";
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
