// Shows that end badly, and the next start: what the performer had is there again.
#include "engine/recovery_keeper.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "engine/edited.h"
#include "engine/taken.h"

namespace limber::engine_test {
namespace {

constexpr const char* kRecoverScene = R"(
params { { "wind", 1, max = 10 } }
local ball = sim:add_sphere_shape("ball", 0.1)
for i = 1, 3 do sim:add_body("b" .. i):add_part("p", ball, { position = vec3(i, 0, 1) }) end
sim:body("b1"):add_behavior("force", "wind", { amp = 0 })
)";

struct RecoveryShow {
  ShowFolder folder;
  EngineOptions options;

  RecoveryShow() {
    log_to_stderr(false);
    folder.write("scripts/scene.lua", kRecoverScene);
    options = fast_options(folder.path("scripts/scene.lua"));
    options.recovery = folder.path("state");
    options.recovery_every = std::chrono::milliseconds(1);
  }
  std::string saved() const {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(options.recovery, none)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".json") && !name.ends_with(".lost.json")) return take_bytes(entry.path().string());
    }
    return {};
  }
  // ticks until that stands in the file
  void play_until_saved(Show& show, const std::string& text) const {
    while (saved().find(text) == std::string::npos) show.ticks(1);
  }
  // what is said since
  static bool said(std::uint64_t since, const std::string& text) {
    return std::ranges::any_of(log_since(since),
                               [&](const LogLine& line) { return line.text.find(text) != line.text.npos; });
  }
  // a show in which these were set, and which did not end well
  void crash() const {
    Show show(options);
    show.send("/physics/sim/gravity", 0, 0, -3.5);
    show.send("/scene/wind", 7);
    show.send("/physics/behavior/parameter", "b1", "wind", "amp", 2.25);
    show.ticks(1);
    play_until_saved(show, "\"amp\": 2.25");
  }
};

TEST(Recovery, ACrashedShowIsToldOfAndBroughtBack) {
  const RecoveryShow rig;
  rig.crash();
  {
    const std::uint64_t before = log_newest();
    Show show(rig.options);
    EXPECT_TRUE(RecoveryShow::said(before, "the last run of this scene did not end well; 3 values of "));
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -9.81);
    show.ticks(20);
    show.engine.end_recovery();
  }
  EngineOptions options = rig.options;
  options.recover = true;
  options.sets = {message("/scene/wind", 3)};
  {
    const std::uint64_t before = log_newest();
    Show show(options);
    EXPECT_TRUE(RecoveryShow::said(before, "--recover: 3 values are back as they were at "));
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5);
    EXPECT_EQ(show.read("/physics/body/b1/behavior/wind/amp"), 2.25);
    EXPECT_EQ(show.read("/scene/wind"), 3) << "the command line is newer";
    show.send("/transport/reset");
    show.ticks(2);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5) << "as the performer's";
    show.engine.end_recovery();
  }
  const std::uint64_t before = log_newest();
  const Show show(options);
  EXPECT_TRUE(RecoveryShow::said(before, "--recover: there is nothing to recover"));
}

TEST(Recovery, WhatTheSceneSaysOtherwiseSinceStaysAndWhatIsGoneIsSaid) {
  const RecoveryShow rig;
  rig.crash();
  std::string text = kRecoverScene;
  text.erase(text.find("sim:body(\"b1\")"));
  rig.folder.write("scripts/scene.lua", text + "sim.timestep = 0.01\n");
  EngineOptions options = rig.options;
  options.recover = true;
  const std::uint64_t before = log_newest();
  Show show(options);
  EXPECT_TRUE(RecoveryShow::said(before, "1 thing is gone (/physics/body/b1/behavior/wind)"));
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5);
  EXPECT_EQ(show.read("/physics/sim/timestep"), 0.01);
}

TEST(Recovery, ACrashRightAfterItLosesNothing) {
  RecoveryShow rig;
  rig.crash();
  rig.options.recover = true;
  rig.options.recovery_every = std::chrono::hours(1);
  for (int i = 0; i < 2; i++) {
    Show show(rig.options);
    show.ticks(3);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5);
  }
}

TEST(Recovery, ADamagedFileIsToldAndTheShowPlays) {
  RecoveryShow rig;
  rig.crash();
  for (const auto& entry : std::filesystem::directory_iterator(rig.options.recovery)) {
    if (entry.path().extension() == ".json") std::filesystem::resize_file(entry.path(), 200);
  }
  rig.options.recover = true;
  const std::uint64_t before = log_newest();
  Show show(rig.options);
  EXPECT_TRUE(RecoveryShow::said(before, "the values of a run that did not end well can't be brought back"));
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/sim/tick"), 3);
}

TEST(Recovery, TheSecondProgramTakesOverWhenTheFirstHasEnded) {
  const RecoveryShow rig;
  std::optional<Show> first(std::in_place, rig.options);
  first->send("/physics/sim/gravity", 0, 0, -3.5);
  first->ticks(1);
  rig.play_until_saved(*first, "-3.5");
  std::uint64_t before = log_newest();
  Show second(rig.options);
  EXPECT_TRUE(RecoveryShow::said(before, "another program plays this scene and owns its presets and recovery file"));
  second.send("/physics/sim/gravity", 0, 0, -7.5);
  second.ticks(100);
  EXPECT_EQ(rig.saved().find("-7.5"), std::string::npos);
  before = log_newest();
  first->engine.end_recovery();
  first.reset();
  rig.play_until_saved(second, "-7.5");
  EXPECT_TRUE(RecoveryShow::said(before, "the other program that played this scene has ended"));
}

TEST(Recovery, AnotherSceneHasItsOwn) {
  RecoveryShow rig;
  rig.folder.write("scripts/other.lua", kRecoverScene);
  {
    Show show(rig.options);
    show.send("/physics/sim/gravity", 0, 0, -3.5);
    show.ticks(1);
    rig.play_until_saved(show, "-3.5");
    std::thread run([&] { show.engine.run(); });
    EXPECT_TRUE(show.engine.change_scene(rig.folder.path("scripts/other.lua")).ok());
    show.engine.stop();
    run.join();
    show.send("/physics/sim/gravity", 0, 0, -4.5);
    show.ticks(1);
    rig.play_until_saved(show, "-4.5");
  }
  rig.options.recover = true;
  {
    const std::uint64_t before = log_newest();
    Show show(rig.options);
    EXPECT_TRUE(RecoveryShow::said(before, "there is nothing to recover")) << "it was left in good order";
    show.engine.end_recovery();
  }
  rig.options.scene = rig.folder.path("scripts/other.lua");
  Show show(rig.options);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -4.5);
}

TEST(Recovery, ATakeThatBeginsWithRecoveredValuesIsReplayed) {
  RecoveryShow rig;
  rig.crash();
  rig.options.recover = true;
  rig.options.record = rig.folder.path("recovered.take");
  std::uint64_t hash = 0;
  {
    Show show(rig.options);
    show.ticks(60);
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
    show.engine.end_recovery();
  }
  expect_replay(rig.options.record, hash);
}

TEST(Recovery, ThatValuesAreKeptChangesNothing) {
  const auto hash = [](const EngineOptions& options) {
    Show show(options);
    for (int i = 0; i < 100; i++) {
      show.send("/scene/wind", i % 10);
      show.ticks(1);
    }
    return show.engine.state_hash();
  };
  const RecoveryShow rig;
  EXPECT_EQ(hash(rig.options), hash(fast_options(rig.options.scene)));
}

}  // namespace
}  // namespace limber::engine_test
