// FramePace: frames counted on a simulated clock; and an idle window on a real display.
#include "app/view/frame_pace.h"

#include "app/display.h"

namespace limber::app::test {
namespace {

constexpr double kRate = 60;

// polls like the window's loop until `end`; `changes(now)` returns true on a change
template <class Changes>
int pictures(FramePace& pace, double& now, double end, Changes changes) {
  int count = 0;
  while (now < end) {
    now += std::max(pace.wait_time(now, kRate), 0.001);
    if (changes(now)) pace.note_activity(now);
    if (!pace.frame_due(now, kRate)) continue;
    pace.begin_frame(now);
    count++;
  }
  return count;
}

TEST(FramePace, DrawsAtTheScreensRateDuringChanges) {
  FramePace pace;
  double now = 100;
  pace.note_activity(now);
  EXPECT_NEAR(pictures(pace, now, 110, [](double) { return true; }), 10 * kRate / 0.95, 2);
}

TEST(FramePace, DrawsFourTimesASecondWhenIdle) {
  FramePace pace;
  double now = 100;
  pace.note_activity(now);
  EXPECT_NEAR(pictures(pace, now, 101, [](double) { return false; }), kRate / 0.95, 2) << "a second at the full rate";
  EXPECT_NEAR(pictures(pace, now, 111, [](double) { return false; }), 40, 2);
}

TEST(FramePace, DrawsAChangeAtTheNextCheck) {
  FramePace pace;
  double now = 100;
  pace.note_activity(now);
  (void)pictures(pace, now, 105, [](double) { return false; });
  for (int i = 0; i < 20; i++) {
    const double changed = now + 0.01 * i;
    (void)pictures(pace, now, changed, [](double) { return false; });
    const double before = now;
    EXPECT_GE(pictures(pace, now, before + FramePace::kIdleCheckInterval, [](double) { return true; }), 1) << i;
    EXPECT_LE(now - before, 2 * FramePace::kIdleCheckInterval + 1e-9);
    (void)pictures(pace, now, now + 2, [](double) { return false; });
  }
}

// the title contains the frame rate
TEST(Window, IdlesWhilePaused) {
  const Display display;
  const TempFolder folder;
  const std::string scene = folder.file("s.lua", R"(
sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1))
sim:after(0.1, function() sim.paused = true print("paused") end)
)");
  Process running(limber_command(quiet(scene), display.environment()));
  ASSERT_TRUE(running.wait_for("limber: window 64 × 36")) << running.err();
  ASSERT_TRUE(running.wait_for("paused", true));
  std::vector<std::string> title_command = display.environment();
  title_command.insert(title_command.end(), {"xdotool", "search", "--name", "Limber: ", "getwindowname"});
  const auto title = [&] { return Process(title_command).finish().out; };
  int left = 600;
  while (title().find("  4 frames per second") == std::string::npos && --left > 0) usleep(100'000);
  EXPECT_GT(left, 0) << title();
}

}  // namespace
}  // namespace limber::app::test
