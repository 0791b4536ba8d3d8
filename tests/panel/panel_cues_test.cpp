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

TEST(PanelCues, WithoutCuesTheButtonsAreOff) {
  CuesFixture cues("");
  PanelFixture& panel = *cues.fixture;
  EXPECT_TRUE(panel.is_visible("cues.go"));
  panel.click("cues.go");
  EXPECT_EQ(panel.read("/cue/current"), 0);
}

}  // namespace
}  // namespace limber::panel::test
