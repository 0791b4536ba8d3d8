// The list of cues, its buttons and its keys.
#include <fstream>

#include "panel/rig.h"

namespace limber::panel::test {
namespace {

constexpr const char* kPanelCues = R"({
  "limber cues": 1,
  "cues": [
    { "name": "calm", "messages": [["/scene/rate", 0.25]] },
    { "name": "storm ##1", "messages": [["/scene/rate", 1.5]], "follow": 2 },
    { "name": "end", "messages": [["/scene/rate", 2]] }
  ]
})";

/// A panel with these cues.
struct CuesFixture {
  explicit CuesFixture(const std::string& cues) {
    std::ofstream(std::filesystem::path(scene.path()).replace_extension(".cues.json")) << cues;
    fixture.emplace(engine::test::fast_options(scene.path()));
    fixture->click("tab:cues");
  }

  engine::test::SceneFile scene{kScene};
  std::optional<PanelFixture> fixture;
};

TEST(PanelCues, ButtonsStartAndPauseCues) {
  CuesFixture cues(kPanelCues);
  PanelFixture& panel = *cues.fixture;
  panel.click("cues.go");
  EXPECT_EQ(panel.read("/cue/current"), 1);
  EXPECT_EQ(panel.read("/scene/rate"), 0.25);
  panel.click("cues.go");
  EXPECT_EQ(panel.read("/scene/rate"), 1.5);
  panel.click("cues.pause");
  EXPECT_EQ(panel.read("/cue/paused"), 1);
  panel.show.ticks(200);
  EXPECT_EQ(panel.read("/cue/current"), 2);
  panel.click("cues.pause");
  EXPECT_EQ(panel.read("/cue/paused"), 0);
  panel.click("cues.back");
  EXPECT_EQ(panel.read("/cue/current"), 1);
}

TEST(PanelCues, AClickStartsACue) {
  CuesFixture cues(kPanelCues);
  PanelFixture& panel = *cues.fixture;
  panel.click("cues.cue:end");
  EXPECT_EQ(panel.read("/scene/rate"), 2);
  panel.click("cues.cue:storm ##1");
  EXPECT_EQ(panel.read("/cue/current"), 2);
}

TEST(PanelCues, KeysStartAndPauseCues) {
  CuesFixture cues(kPanelCues);
  PanelFixture& panel = *cues.fixture;
  panel.key(GuiKey::f5);
  panel.key(GuiKey::f5);
  EXPECT_EQ(panel.read("/cue/current"), 2);
  panel.key(GuiKey::f6);
  EXPECT_EQ(panel.read("/cue/paused"), 1);
  panel.key(GuiKey::f5, kShift);
  EXPECT_EQ(panel.read("/cue/current"), 1);
}

// The panel sends edits, which the program's watch thread executes.
TEST(PanelCues, CuesAreEditedInTheirMenu) {
  CuesFixture cues(kPanelCues);
  PanelFixture& panel = *cues.fixture;
  std::vector<std::string> requests;
  panel.show.link.on_scene_request = [&](const Message& message, const CommandOrigin&) {
    std::string text = message.address;
    for (const Arg& arg : message.args) text += " " + (arg.is_text() ? arg.text : number_text(arg.number));
    requests.push_back(text);
  };
  panel.click("cues.add");
  panel.type("lift");
  panel.click("cues.add_now");
  panel.click("cues.cue:end", 1);
  panel.click("menu:cue_up");
  panel.click("cues.cue:end", 1);
  panel.click("menu:cue_delete");
  panel.click("cues.cue:calm", 1);
  panel.click("cues.field:at");
  panel.click("cues.at:bar");
  EXPECT_EQ(requests,
            (std::vector<std::string>{"/cue/add lift lift", "/cue/move 3 2", "/cue/remove 3", "/cue/set 1 at bar"}));
  EXPECT_EQ(panel.read("/cue/current"), 0) << "nothing was started";
}

TEST(PanelCues, TheClockIsPlayedFromThePanel) {
  CuesFixture cues(kPanelCues);
  PanelFixture& panel = *cues.fixture;
  EXPECT_TRUE(panel.is_visible("clock.state"));
  panel.click("clock.playing");
  EXPECT_EQ(panel.read("/clock/playing"), 0);
  panel.show.ticks(50);
  const double beat = panel.read("/clock/beat");
  panel.click("clock.playing");
  panel.show.ticks(30);
  EXPECT_GT(panel.read("/clock/beat"), beat + 0.9);
  panel.click("clock.start");
  EXPECT_LT(panel.read("/clock/beat"), 1);
  panel.click("clock.tap");
  const double tick = panel.read("/physics/sim/tick");
  panel.show.ticks(25);
  panel.key(GuiKey::f7);
  const double ticks = panel.read("/physics/sim/tick") - tick;
  EXPECT_NEAR(panel.read("/clock/tempo"), 3600 / ticks, 0.2 * 3600 / ticks) << "a beat in " << ticks << " ticks";
}

TEST(PanelCues, WithoutCuesTheButtonsAreOff) {
  CuesFixture cues("");
  PanelFixture& panel = *cues.fixture;
  EXPECT_TRUE(panel.is_visible("cues.go"));
  panel.click("cues.go");
  EXPECT_EQ(panel.read("/cue/current"), 0);
}

}  // namespace
}  // namespace limber::panel::test
