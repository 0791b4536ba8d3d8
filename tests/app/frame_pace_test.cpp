// FramePace: pictures are counted along a clock that the test turns; and a window that idles on a real display.
#include "app/frame_pace.h"

#include "app/display.h"

namespace limber::app_test {
namespace {

constexpr double kRate = 60;

// looks as the window's loop does, until `end`; `changes(now)` tells whether something has changed
template <class Changes>
int pictures(FramePace& pace, double& now, double end, Changes changes) {
  int count = 0;
  while (now < end) {
    now += std::max(pace.rest(now, kRate), 0.001);
    if (changes(now)) pace.touch(now);
    if (!pace.due(now, kRate)) continue;
    pace.draw(now);
    count++;
  }
  return count;
}

TEST(FramePace, DrawsAtTheScreensRateWhileSomethingChanges) {
  FramePace pace;
  double now = 100;
  pace.touch(now);
  EXPECT_NEAR(pictures(pace, now, 110, [](double) { return true; }), 10 * kRate / 0.95, 2);
}

TEST(FramePace, DrawsFourTimesASecondWhileNothingDoes) {
  FramePace pace;
  double now = 100;
  pace.touch(now);
  EXPECT_NEAR(pictures(pace, now, 101, [](double) { return false; }), kRate / 0.95, 2) << "a second at the full rate";
  EXPECT_NEAR(pictures(pace, now, 111, [](double) { return false; }), 40, 2);
}

TEST(FramePace, AChangeIsDrawnAtTheNextLook) {
  FramePace pace;
  double now = 100;
  pace.touch(now);
  (void)pictures(pace, now, 105, [](double) { return false; });
  for (int i = 0; i < 20; i++) {
    const double changed = now + 0.01 * i;
    (void)pictures(pace, now, changed, [](double) { return false; });
    const double before = now;
    EXPECT_GE(pictures(pace, now, before + FramePace::kIdleLook, [](double) { return true; }), 1) << i;
    EXPECT_LE(now - before, 2 * FramePace::kIdleLook + 1e-9);
    (void)pictures(pace, now, now + 2, [](double) { return false; });
  }
}

// the title tells how many pictures were drawn in a second
TEST(Window, APausedWindowIdlesUntilItIsTouched) {
  const Display display;
  const Folder folder;
  const std::string scene = folder.file("s.lua", R"(
sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1))
sim:after(0.1, function() sim.paused = true print("paused") end)
)");
  Running running(limber(quiet(scene), display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 64 × 36")) << running.err();
  ASSERT_TRUE(running.wait_for("paused", true));
  std::vector<std::string> look = display.environment();
  look.insert(look.end(), {"xdotool", "search", "--name", "Limber: ", "getwindowname"});
  const auto title = [&] { return Running(look).finish().out; };
  int left = 600;
  while (title().find("  4 pictures a second") == std::string::npos && --left > 0) usleep(100'000);
  EXPECT_GT(left, 0) << title();
}

}  // namespace
}  // namespace limber::app_test
