// The node /take while recording, while replaying, and without a take.
#include "engine/show.h"

namespace limber::engine::test {
namespace {

constexpr const char* kFalling = R"(
sim:add_sphere_shape("ball", 0.1)
sim:add_body("one"):add_part("ball", "ball", { mass = 1, position = vec3(0, 0, 5) })
)";

// Returns the reply to /get /take/name.
std::string reply_to_name(Show& show) {
  show.sent_texts();
  show.send("/get", "/take/name");
  show.engine.idle();
  for (const std::string& line : show.sent_texts()) {
    if (line.starts_with("/take/name ")) return line.substr(11);
  }
  return "no answer";
}

TEST(TakeNode, ShowsTheRecordedTake) {
  const SceneFile file(kFalling);
  Show show(file.path());
  show.ticks(3);
  EXPECT_EQ(reply_to_name(show), "");
  show.send("/take/record", "dusk");
  show.engine.idle();
  show.ticks(10);
  EXPECT_EQ(reply_to_name(show), "dusk");
  EXPECT_EQ(show.read("/take/ticks"), 10);
  EXPECT_EQ(show.read("/take/replays"), 0);
  show.send("/transport/pause");
  show.ticks(5);
  show.send("/physics/sim/gravity", -1.0);
  show.ticks(5);
  EXPECT_EQ(show.read("/take/ticks"), 10) << "paused";
  show.send("/transport/play");
  show.ticks(1);
  EXPECT_EQ(show.read("/take/ticks"), 11);
  show.send("/take/stop");
  show.ticks(1);
  EXPECT_EQ(reply_to_name(show), "");
  EXPECT_EQ(show.read("/take/ticks"), 0);
}

TEST(TakeNode, ShowsProgressAndLengthOfAReplay) {
  const SceneFile file(kFalling);
  EngineOptions options = fast_options(file.path());
  options.record = file.path() + ".take";
  {
    Show show(options);
    show.ticks(20);
    show.send("/transport/pause");
    show.ticks(4);
    show.send("/transport/play");
    show.send("/transport/reset");
    show.ticks(30);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  EngineOptions replay = fast_options();
  replay.replay = options.record;
  Show show(replay);
  EXPECT_EQ(show.read("/take/replays"), 1);
  EXPECT_EQ(show.read("/take/whole"), 50) << "pauses are not counted, and a reset does not end the take";
  while (show.read("/take/ticks") < 35 && !show.engine.replay_finished()) show.engine.tick();
  EXPECT_EQ(show.read("/take/ticks"), 35);
  EXPECT_EQ(show.read("/physics/sim/tick"), 14) << "since the reset, which follows the first tick there";
  while (!show.engine.replay_finished()) show.engine.tick();
  EXPECT_EQ(show.read("/take/ticks"), 50);
  EXPECT_EQ(show.engine.replay_result().diverged_at, std::nullopt);
}

TEST(TakeNode, CountsCompleteTicksOfATruncatedTake) {
  const SceneFile file(kFalling);
  EngineOptions options = fast_options(file.path());
  options.record = file.path() + ".take";
  {
    Show show(options);
    show.ticks(40);
    show.engine.end_take();
    show.engine.finish_saving();
  }
  std::filesystem::resize_file(options.record, std::filesystem::file_size(options.record) - 200);
  EngineOptions replay = fast_options();
  replay.replay = options.record;
  Show show(replay);
  const double whole = show.read("/take/whole");
  EXPECT_LT(whole, 40);
  while (!show.engine.replay_finished()) show.engine.tick();
  EXPECT_EQ(show.read("/take/ticks"), whole);
}

}  // namespace
}  // namespace limber::engine::test
