// The panel as a whole: hiding, help, text size, registration of panels, missing fonts.
#include "ui/panel/gui.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <imgui.h>

#include "panel/rig.h"

namespace limber::panel::test {
namespace {

TEST(Gui, EveryPanelFileRegistersItself) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(LIMBER_SOURCE_DIR "/src/ui/panel/panels"))
    files.insert(entry.path().stem().string());
  std::set<std::string> kinds;
  for (const PanelType& kind : panel_types()) kinds.insert(std::string(kind.name));
  EXPECT_EQ(kinds, files);
}

TEST(Gui, F1HidesPanelAndF2ShowsHelp) {
  PanelFixture fixture;
  EXPECT_TRUE(fixture.is_visible("transport.play"));
  fixture.key(GuiKey::f1);
  fixture.frames(2);
  EXPECT_FALSE(fixture.is_visible("transport.play"));
  EXPECT_FALSE(fixture.gui->wants_mouse());
  fixture.key(GuiKey::f1);
  fixture.frames(2);
  EXPECT_TRUE(fixture.is_visible("transport.play"));
  fixture.key(GuiKey::f2);
  EXPECT_TRUE(fixture.gui->context().show_help);
}

// Returns the topmost window, which is drawn last.
std::string topmost_window() {
  const ImDrawData* const draw_data = ImGui::GetDrawData();
  return draw_data->CmdLists[draw_data->CmdListsCount - 1]->_OwnerName;
}

TEST(Gui, DrawsHelpAndNoticesAbovePanels) {
  PanelFixture fixture(kScene, 900, 600);
  fixture.key(GuiKey::f2);
  fixture.frames(2);
  EXPECT_EQ(topmost_window(), "##help");
  fixture.key(GuiKey::f2);
  fixture.key(GuiKey::z, {true, false, false});
  fixture.frames(2);
  EXPECT_EQ(topmost_window(), "##notice");
}

TEST(Gui, HelpFitsSmallWindow) {
  for (const auto& [width, height] : {std::pair(800.0, 450.0), {1600.0, 900.0}}) {
    PanelFixture fixture(kScene, width, height);
    fixture.key(GuiKey::f2);
    fixture.frames(3);
    const PanelRect first = fixture.rect_of("help:panic");
    const PanelRect last = fixture.rect_of("help:Tab, arrows, Enter");
    EXPECT_GT(last.y, first.y);
    EXPECT_LT(last.y + last.height, height - 8) << width;
    EXPECT_GE(last.height, 10.5) << "and can be read";
  }
}

TEST(Gui, ClickInHelpRebindsKey) {
  PanelFixture fixture;
  fixture.key(GuiKey::f2);
  fixture.frames(3);
  const auto choose = [&](GuiKey key, KeyMods mods = {}) {
    fixture.click("help:panic");
    fixture.key(key, mods);
    fixture.frames(2);
    return fixture.gui->settings().keys;
  };
  EXPECT_EQ(choose(GuiKey::f9), (KeyBindings{{"panic", "F9"}}));
  EXPECT_EQ(choose(GuiKey::r, kCtrl), (KeyBindings{{"panic", "F9"}})) << "the key is in use";
  EXPECT_EQ(choose(GuiKey::escape), (KeyBindings{{"panic", "F9"}}));
  fixture.key(GuiKey::f2);
  fixture.key(GuiKey::f12);
  fixture.sync();
  EXPECT_FALSE(fixture.gui->context().panicked());
  fixture.key(GuiKey::f9);
  fixture.sync();
  EXPECT_TRUE(fixture.gui->context().panicked());
  fixture.key(GuiKey::f2);
  fixture.frames(3);
  EXPECT_EQ(choose(GuiKey::erase), KeyBindings());
  fixture.click("help:recall");
  fixture.key(GuiKey::f9);
  EXPECT_EQ(fixture.gui->settings().keys, KeyBindings()) << "eight keys";
}

TEST(Gui, UsesKeysOfSettings) {
  GuiOptions options = PanelFixture::headless();
  options.settings.keys = {{"help", "Ctrl+H"}, {"nothing", "F9"}};
  engine::EngineLink link;
  const std::uint64_t before = log_newest();
  Gui gui(link, options);
  EXPECT_TRUE(std::ranges::any_of(log_since(before), [](const LogLine& line) {
    return line.text.find("key 'F9' for 'nothing'") != line.text.npos;
  }));
  gui.push({.kind = InputEvent::Kind::key, .key = GuiKey::h, .down = true, .mods = kCtrl});
  gui.frame({800, 600, 1, 0.1});
  EXPECT_TRUE(gui.context().show_help);
}

TEST(Gui, F3TogglesDebugOverlay) {
  PanelFixture fixture;
  fixture.key(GuiKey::f3);
  EXPECT_EQ(fixture.read("/visuals/look/overlay"), 1);
  fixture.key(GuiKey::f3);
  EXPECT_EQ(fixture.read("/visuals/look/overlay"), 0);
}

TEST(Gui, StoresAndRestoresViews) {
  PanelFixture fixture;
  const auto move_camera = [&](double x) {
    for (const char* address : {"/visuals/camera/eye", "/visuals/camera/target", "/visuals/camera/eye"})
      fixture.show.send(address, x, std::string_view(address).ends_with("eye") ? -5.0 : 1.0, 2.0);
    fixture.sync();
  };
  move_camera(3);
  fixture.key(GuiKey::digit_1, kCtrlShift);
  move_camera(7);
  fixture.key(GuiKey::digit_9, kCtrlShift);
  move_camera(11);
  fixture.key(GuiKey::digit_5, kCtrl);
  EXPECT_NEAR(fixture.read("/visuals/camera/eye"), 11, 1e-6) << "there is none";
  EXPECT_NE(fixture.gui->context().notice.text.find("View 5 is empty"), std::string::npos)
      << fixture.gui->context().notice.text;
  for (const auto& [key, x] : {std::pair(GuiKey::digit_1, 3.0), {GuiKey::digit_9, 7.0}}) {
    fixture.key(key, kCtrl);
    EXPECT_NEAR(fixture.read("/visuals/camera/eye", 0), x, 1e-6);
    EXPECT_NEAR(fixture.read("/visuals/camera/eye", 1), -5, 1e-6);
    EXPECT_NEAR(fixture.read("/visuals/camera/target", 0), x, 1e-6);
    EXPECT_NEAR(fixture.read("/visuals/camera/target", 1), 1, 1e-6);
  }
  EXPECT_EQ(fixture.gui->consume_actions().back(), HotkeyAction::restore_view) << "following has ended";
}

TEST(Gui, RestoresStyleUnlessSceneSetsOne) {
  PanelFixture fixture;
  fixture.click("parameters.search");
  fixture.type("look style");
  fixture.click("/visuals/look/style");
  fixture.click("/visuals/look/style=studio");
  EXPECT_EQ(fixture.read("/visuals/look/style"), 1);
  const GuiSettings settings = fixture.gui->settings();
  EXPECT_EQ(settings.style, "studio");
  for (const auto& [scene, style] :
       {std::pair(std::string(kScene), 1.0), {std::string(kScene) + "visuals.look.style = \"stage\"\n", 0.0}}) {
    PanelFixture next(scene);
    GuiOptions options = PanelFixture::headless();
    options.settings = settings;
    next.gui = std::make_unique<Gui>(next.show.link, std::move(options));
    next.sync();
    next.sync();
    EXPECT_EQ(next.read("/visuals/look/style"), style);
  }
}

TEST(Gui, LimitsTextSize) {
  PanelFixture fixture;
  const double before = fixture.rect_of("transport.play").height;
  for (int i = 0; i < 20; i++) fixture.key(GuiKey::equal, kCtrl);
  EXPECT_EQ(fixture.gui->settings().text_size, 28);
  EXPECT_NEAR(fixture.rect_of("transport.play").height / before, 28.0 / 16, 0.1);
  for (int i = 0; i < 30; i++) fixture.key(GuiKey::minus, kCtrl);
  EXPECT_EQ(fixture.gui->settings().text_size, 12);
}

TEST(Gui, ShowsFavoritesOnly) {
  PanelFixture fixture;
  fixture.click("star:/scene/rate");
  fixture.click("star:/physics/sim/gravity");
  fixture.click("parameters.favorites");
  EXPECT_TRUE(fixture.is_visible("/scene/rate"));
  EXPECT_TRUE(fixture.is_visible("/physics/sim/gravity/2"));
  EXPECT_FALSE(fixture.is_visible("/scene/lit"));
  fixture.drag("/scene/rate", 0.9);
  EXPECT_GT(fixture.read("/scene/rate"), 1.5);
  fixture.click("star:/scene/rate");
  EXPECT_FALSE(fixture.is_visible("/scene/rate"));
}

TEST(Gui, SearchesAllProperties) {
  PanelFixture fixture;
  fixture.key(GuiKey::f, {true, false, false});
  fixture.type("LEG tip mass");
  fixture.frames(5);
  ASSERT_TRUE(fixture.is_visible("/physics/body/leg/part/tip/mass"));
  EXPECT_FALSE(fixture.is_visible("/physics/body/arm/part/tip/mass"));
}

TEST(Gui, SupportsKeyboardNavigation) {
  PanelFixture fixture;
  fixture.click("parameters.search");
  fixture.type("scene rate");
  fixture.frames(4);
  fixture.key(GuiKey::enter);
  fixture.key(GuiKey::down);
  fixture.key(GuiKey::down);
  fixture.key(GuiKey::enter);
  fixture.key(GuiKey::a, {true, false, false});
  fixture.type("1.25");
  fixture.key(GuiKey::enter);
  EXPECT_EQ(fixture.read("/scene/rate"), 1.25);
}

TEST(Gui, ReturnsOnlyActionsOfTheWindow) {
  PanelFixture fixture;
  fixture.key(GuiKey::f11);
  fixture.key(GuiKey::home);
  fixture.key(GuiKey::f2);
  EXPECT_EQ(fixture.gui->consume_actions(),
            (std::vector<HotkeyAction>{HotkeyAction::toggle_full_screen, HotkeyAction::default_view}));
  EXPECT_TRUE(fixture.gui->consume_actions().empty());
}

TEST(Gui, FramesOnlyWithThePointerOverTheView) {
  PanelFixture fixture;
  const PanelRect view = fixture.gui->layout().view;
  fixture.move(view.x + view.width / 2, view.y + view.height / 2);
  fixture.frames(2);
  fixture.key(GuiKey::f);
  fixture.key(GuiKey::a);
  EXPECT_EQ(fixture.gui->consume_actions(),
            (std::vector<HotkeyAction>{HotkeyAction::frame_selection, HotkeyAction::frame_all}));
  fixture.point("tree:/physics/body/arm");
  fixture.key(GuiKey::f);
  fixture.key(GuiKey::a);
  EXPECT_TRUE(fixture.gui->consume_actions().empty()) << "over a panel";
  fixture.click("parameters.search");
  fixture.move(view.x + view.width / 2, view.y + view.height / 2);
  fixture.frames(2);
  fixture.key(GuiKey::f);
  fixture.key(GuiKey::a);
  EXPECT_TRUE(fixture.gui->consume_actions().empty()) << "in a text field";
  fixture.key(GuiKey::f2);
  EXPECT_TRUE(fixture.is_visible("help:frame"));
  EXPECT_TRUE(fixture.is_visible("help:frame_all"));
}

TEST(Gui, SupportsTinyWindow) {
  PanelFixture fixture;
  fixture.resize(1, 1);
  EXPECT_TRUE(fixture.gui->names().all().empty());
  fixture.resize(1600, 900);
  EXPECT_TRUE(fixture.is_visible("transport.play"));
}

// A box-drawing character is used for the characters that both fonts lack: the fallback font contains it.
TEST(Gui, UsesFallbackFontForNames) {
  const std::string scene = std::string(kScene) + "sim:add_body('\u250crm \u8155')\n";
  PanelFixture fixture(scene);
  const std::filesystem::path root = fixture.folder() / "fonts_of_a_test";
  const std::filesystem::path droid = root / "usr/share/fonts/truetype/droid";
  std::filesystem::create_directories(droid);
  std::filesystem::copy_file("/usr/share/fonts/truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
                             droid / "DroidSansFallbackFull.ttf");
  GuiOptions options = PanelFixture::headless();
  options.font_root = root.string();
  fixture.gui = std::make_unique<Gui>(fixture.show.link, std::move(options));
  fixture.sync();
  fixture.frames(2);
  for (const ImFont* font : {fixture.gui->context().fonts.text, fixture.gui->context().fonts.code}) {
    EXPECT_NE(font->FindGlyphNoFallback(0x250c), nullptr);
    EXPECT_EQ(font->FindGlyphNoFallback(0x2510), nullptr) << "unused characters are not loaded";
  }
  std::filesystem::remove_all(root);
  const std::uint64_t warnings_before = log_count(LogLevel::warning);
  GuiOptions none = PanelFixture::headless();
  none.font_root = "/nowhere";
  fixture.gui = std::make_unique<Gui>(fixture.show.link, std::move(none));
  fixture.sync();
  fixture.frames(2);
  EXPECT_EQ(log_count(LogLevel::warning), warnings_before + 3) << "two fonts are missing, and one for these letters";
}

TEST(Gui, ReportsMissingFonts) {
  const FontFiles none = find_fonts("/nowhere");
  ASSERT_EQ(none.warnings.size(), 2u);
  EXPECT_NE(none.warnings[0].find("apt-get install fonts-inter"), std::string::npos);
  EXPECT_NE(none.warnings[1].find("apt-get install fonts-jetbrains-mono"), std::string::npos);
  engine::EngineLink link;
  GuiOptions options = PanelFixture::headless();
  options.font_root = "/nowhere";
  Gui gui(link, std::move(options));
  gui.frame({800, 600, 1, 0.1});
  EXPECT_NE(gui.context().fonts.text, nullptr) << "the built-in font is used";
}

TEST(Gui, SupportsSeveralInstances) {
  PanelFixture one;
  PanelFixture two;
  one.key(GuiKey::f1);
  two.frames(2);
  EXPECT_TRUE(one.gui->settings().hidden);
  EXPECT_FALSE(two.gui->settings().hidden);
}

}  // namespace
}  // namespace limber::panel::test
