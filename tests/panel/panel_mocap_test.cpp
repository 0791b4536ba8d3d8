// The list of sources of motion capture, and the player of a file.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

constexpr const char* kMocapScene = R"(
sim:add_mocap("file", { source = "motion/dancer.bvh", unit = "cm" })
sim:add_mocap("live", { messages = { ["/joint"] = "joint x y z" }, joints = { "head", "hand" } })
)";

struct MocapFixture {
  MocapFixture() {
    const std::filesystem::path folder = std::filesystem::path(scene.path()).parent_path();
    std::filesystem::create_directories(folder / "motion");
    std::filesystem::copy_file(LIMBER_SOURCE_DIR "/scripts/motion/dancer.bvh", folder / "motion/dancer.bvh",
                               std::filesystem::copy_options::overwrite_existing);
    fixture.emplace(engine::test::fast_options(scene.path()));
    fixture->show.ticks(3);
    fixture->sync();
    fixture->click("tab:mocap");
  }
  engine::test::SceneFile scene{kMocapScene};
  std::optional<PanelFixture> fixture;
};

TEST(PanelMocap, ListsSourcesAndSelectsThem) {
  MocapFixture mocap;
  PanelFixture& panel = *mocap.fixture;
  panel.click("mocap.source:live");
  EXPECT_EQ(panel.gui->context().selected, "/physics/mocap/live");
  EXPECT_FALSE(panel.is_visible("mocap.play:live")) << "it has no file";
}

TEST(PanelMocap, PlaysAndScrubsAFile) {
  MocapFixture mocap;
  PanelFixture& panel = *mocap.fixture;
  panel.click("mocap.play:file");
  EXPECT_EQ(panel.read("/physics/mocap/file/playing"), 0);
  panel.click("mocap.time:file", 0, {}, 0.5);
  EXPECT_NEAR(panel.read("/physics/mocap/file/time"), 4, 0.2) << "the middle of eight seconds";
  panel.click("mocap.play:file");
  EXPECT_EQ(panel.read("/physics/mocap/file/playing"), 1);
}

TEST(PanelMocap, ASceneWithoutSourcesSaysHowToAddOne) {
  PanelFixture panel;
  panel.click("tab:mocap");
  EXPECT_FALSE(panel.is_visible("mocap.source:file"));
}

}  // namespace
}  // namespace limber::panel::test
