// The sources of motion capture: their states, the player of a file, and the joints.
#include <string>

#include "panel/drawn_text.h"
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

constexpr const char* kMocapScene = R"(
sim:add_mocap("live", { source = "osc", joints = { "hips", "hand" } })
sim:add_mocap("film", { source = ")" LIMBER_SOURCE_DIR R"(/scripts/motion/dancer.bvh", unit = "cm" })
)";

TEST(PanelMocap, ShowsSourcesAndTheirJoints) {
  PanelFixture fixture(kMocapScene, 1280, 720);
  fixture.click("tab:mocap");
  const auto line = [&](const std::string& name) { return DrawnText().in(fixture.rect_of(name)); };
  const std::string hand = "mocap.joint:/physics/mocap/live/joint/hand";
  EXPECT_EQ(line("mocap:/physics/mocap/live"), "live waits for frames");
  EXPECT_EQ(line(hand), "hand not seen");
  fixture.show.send("/mocap/joint/pos_world", 0.0, 0.0, 1.0, 0.25, -0.5, 1.5);
  fixture.show.ticks(2);
  fixture.sync();
  EXPECT_EQ(line("mocap:/physics/mocap/live"), "live live");
  EXPECT_EQ(line(hand), "hand 0.25 -0.50 1.50 100 %");
  fixture.click(hand);
  EXPECT_EQ(fixture.gui->context().selected, "/physics/mocap/live/joint/hand");
}

TEST(PanelMocap, ReportsALostSource) {
  PanelFixture fixture(kMocapScene, 1280, 720);
  fixture.click("tab:mocap");
  fixture.show.send("/mocap/joint/pos_world", 0.0, 0.0, 1.0, 0.25, -0.5, 1.5);
  fixture.show.ticks(60);
  fixture.sync();
  const auto text = [&](const std::string& name) { return DrawnText().in(fixture.rect_of(name)); };
  EXPECT_EQ(text("tab:mocap"), "Mocap 1 lost");
  EXPECT_EQ(text("mocap:/physics/mocap/live"), "live lost for 1.0 s");
}

TEST(PanelMocap, PlaysAndScrubsAFile) {
  PanelFixture fixture(kMocapScene, 1280, 720);
  fixture.click("tab:mocap");
  fixture.click("/physics/mocap/film/playing");
  EXPECT_EQ(fixture.read("/physics/mocap/film/playing"), 0);
  fixture.click("time:/physics/mocap/film");
  const double half = fixture.read("/physics/mocap/film/duration") / 2;
  EXPECT_NEAR(fixture.read("/physics/mocap/film/time"), half, 0.1 * half);
}

TEST(PanelMocap, ShowsNamesAsTheSceneWritesThem) {
  PanelFixture fixture(R"(sim:add_mocap("my dancer", { source = "osc" }))", 1280, 720);
  fixture.click("tab:mocap");
  EXPECT_EQ(DrawnText().in(fixture.rect_of("mocap:/physics/mocap/my%20dancer")), "my dancer waits for frames");
}

TEST(PanelMocap, ASceneWithoutSourcesSaysHowToAddOne) {
  PanelFixture fixture("", 1280, 720);
  fixture.click("tab:mocap");
  EXPECT_TRUE(fixture.names_with("mocap").empty());
}

}  // namespace
}  // namespace limber::panel::test
