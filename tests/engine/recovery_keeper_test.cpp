// Recovery after a crash: the next start restores the performer's values.
#include "engine/recovery/recovery_saver.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "engine/edited.h"
#include "engine/taken.h"

namespace limber::engine::test {
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
    options.recovery.folder = folder.path("state");
    options.recovery.interval = std::chrono::milliseconds(1);
  }
  std::string saved() const {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(options.recovery.folder, none)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".json") && !name.ends_with(".lost.json")) return file_bytes(entry.path().string());
    }
    return {};
  }
  // Runs ticks until the file contains a text.
  void play_until_saved(Show& show, const std::string& text) const {
    while (saved().find(text) == std::string::npos) show.ticks(1);
  }
  // True if a text was logged since a log position.
  static bool logged(std::uint64_t since, const std::string& text) {
    return std::ranges::any_of(log_since(since),
                               [&](const LogLine& line) { return line.text.find(text) != line.text.npos; });
  }
  // Runs a session that sets some values and then crashes.
  void crash() const {
    Show show(options);
    show.send("/physics/sim/gravity", 0, 0, -3.5);
    show.send("/scene/wind", 7);
    show.send("/physics/behavior/parameter", "b1", "wind", "amp", 2.25);
    show.ticks(1);
    play_until_saved(show, "\"amp\": 2.25");
  }
};

TEST(Recovery, OffersAndRestoresACrashedSession) {
  const RecoveryShow fixture;
  fixture.crash();
  {
    const std::uint64_t before = log_newest();
    Show show(fixture.options);
    EXPECT_TRUE(RecoveryShow::logged(before, "the last run of this scene did not exit cleanly; 3 values of "));
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -9.81);
    show.ticks(20);
    show.engine.end_recovery();
  }
  EngineOptions options = fixture.options;
  options.recovery.restore = true;
  options.sets = {message("/scene/wind", 3)};
  {
    const std::uint64_t before = log_newest();
    Show show(options);
    EXPECT_TRUE(RecoveryShow::logged(before, "--recover: 3 values were restored as of "));
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5);
    EXPECT_EQ(show.read("/physics/body/b1/behavior/wind/amp"), 2.25);
    EXPECT_EQ(show.read("/scene/wind"), 3) << "the command line takes precedence";
    show.send("/transport/reset");
    show.ticks(2);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5) << "recovered values are overrides";
    show.engine.end_recovery();
  }
  const std::uint64_t before = log_newest();
  const Show show(options);
  EXPECT_TRUE(RecoveryShow::logged(before, "--recover: there is nothing to recover"));
}

TEST(Recovery, KeepsEditsOfTheSceneAndReportsMissingObjects) {
  const RecoveryShow fixture;
  fixture.crash();
  std::string text = kRecoverScene;
  text.erase(text.find("sim:body(\"b1\")"));
  fixture.folder.write("scripts/scene.lua", text + "sim.timestep = 0.01\n");
  EngineOptions options = fixture.options;
  options.recovery.restore = true;
  const std::uint64_t before = log_newest();
  Show show(options);
  EXPECT_TRUE(RecoveryShow::logged(before, "1 object was not found (/physics/body/b1/behavior/wind)"));
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5);
  EXPECT_EQ(show.read("/physics/sim/timestep"), 0.01);
}

TEST(Recovery, ASecondCrashLosesNothing) {
  RecoveryShow fixture;
  fixture.crash();
  fixture.options.recovery.restore = true;
  fixture.options.recovery.interval = std::chrono::hours(1);
  for (int i = 0; i < 2; i++) {
    Show show(fixture.options);
    show.ticks(3);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -3.5);
  }
}

TEST(Recovery, ReportsADamagedFileAndPlays) {
  RecoveryShow fixture;
  fixture.crash();
  for (const auto& entry : std::filesystem::directory_iterator(fixture.options.recovery.folder)) {
    if (entry.path().extension() == ".json") std::filesystem::resize_file(entry.path(), 200);
  }
  fixture.options.recovery.restore = true;
  const std::uint64_t before = log_newest();
  Show show(fixture.options);
  EXPECT_TRUE(RecoveryShow::logged(before, "the values of the run that did not exit cleanly can't be restored"));
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/sim/tick"), 3);
}

TEST(Recovery, TheSecondProgramTakesOverAfterTheFirst) {
  const RecoveryShow fixture;
  std::optional<Show> first(std::in_place, fixture.options);
  first->send("/physics/sim/gravity", 0, 0, -3.5);
  first->ticks(1);
  fixture.play_until_saved(*first, "-3.5");
  std::uint64_t before = log_newest();
  Show second(fixture.options);
  EXPECT_TRUE(RecoveryShow::logged(before, "another program plays this scene and owns its presets and recovery file"));
  second.send("/physics/sim/gravity", 0, 0, -7.5);
  second.ticks(100);
  EXPECT_EQ(fixture.saved().find("-7.5"), std::string::npos);
  before = log_newest();
  first->engine.end_recovery();
  first.reset();
  fixture.play_until_saved(second, "-7.5");
  EXPECT_TRUE(RecoveryShow::logged(before, "the other program that played this scene has ended"));
}

// A preset with one number.
std::shared_ptr<const Preset> preset_of(double value) {
  PresetBuilder builder;
  PresetLayout layout;
  layout.add({"x", PropertyType::number, 1, {}});
  builder.add("/sim", std::move(layout), {value});
  return builder.finish("p", {});
}

TEST(Recovery, ValuesThatWaitAreSavedWithoutAnotherTick) {
  const RecoveryShow fixture;
  const std::string scene = fixture.options.scene, folder = fixture.options.recovery.folder;
  const Result<std::unique_ptr<RecoveryFile>> first = RecoveryFile::open(folder, scene);
  ASSERT_TRUE(first.ok() && *first != nullptr);
  BackgroundWriter writer;
  RecoverySaver second(writer, folder, std::chrono::milliseconds(1));
  ASSERT_TRUE(second.open(scene).ok());
  ASSERT_FALSE(second.owned());
  second.begin();
  second.submit(scene, preset_of(-7.5), preset_of(0));
  while (!second.wants_values()) std::this_thread::yield();  // the writer has tried to save them
  EXPECT_EQ(fixture.saved(), "");
  (*first)->end(false);
  while (fixture.saved().find("-7.5") == std::string::npos) std::this_thread::yield();
  EXPECT_TRUE(second.owned());
  second.end();
}

TEST(Recovery, EachSceneHasItsOwnFile) {
  RecoveryShow fixture;
  fixture.folder.write("scripts/other.lua", kRecoverScene);
  {
    Show show(fixture.options);
    show.send("/physics/sim/gravity", 0, 0, -3.5);
    show.ticks(1);
    fixture.play_until_saved(show, "-3.5");
    std::thread run([&] { show.engine.run(); });
    EXPECT_TRUE(show.engine.change_scene(fixture.folder.path("scripts/other.lua")).ok());
    show.engine.stop();
    run.join();
    show.send("/physics/sim/gravity", 0, 0, -4.5);
    show.ticks(1);
    fixture.play_until_saved(show, "-4.5");
  }
  fixture.options.recovery.restore = true;
  {
    const std::uint64_t before = log_newest();
    Show show(fixture.options);
    EXPECT_TRUE(RecoveryShow::logged(before, "there is nothing to recover")) << "its run ended cleanly";
    show.engine.end_recovery();
  }
  fixture.options.scene = fixture.folder.path("scripts/other.lua");
  Show show(fixture.options);
  EXPECT_EQ(show.read("/physics/sim/gravity", 2), -4.5);
}

TEST(Recovery, ReplaysATakeWithRecoveredValues) {
  RecoveryShow fixture;
  fixture.crash();
  fixture.options.recovery.restore = true;
  fixture.options.record = fixture.folder.path("recovered.take");
  std::uint64_t hash = 0;
  {
    Show show(fixture.options);
    show.ticks(60);
    hash = show.engine.state_hash();
    show.engine.end_take();
    show.engine.finish_saving();
    show.engine.end_recovery();
  }
  expect_replay(fixture.options.record, hash);
}

TEST(Recovery, DoesNotChangeTheSimulation) {
  const auto hash = [](const EngineOptions& options) {
    Show show(options);
    for (int i = 0; i < 100; i++) {
      show.send("/scene/wind", i % 10);
      show.ticks(1);
    }
    return show.engine.state_hash();
  };
  const RecoveryShow fixture;
  EXPECT_EQ(hash(fixture.options), hash(fast_options(fixture.options.scene)));
}

}  // namespace
}  // namespace limber::engine::test
