// Takes: a replay is bit-exact and needs nothing but the take.
#include <sstream>

#include "engine/taken.h"
#include "engine/takes/writer.h"
#include "support/skip.h"

namespace limber::engine::test {
namespace {

// without behavior files and models: the take is small enough to test every byte
constexpr const char* kSmallScene = R"(
local ball = sim:add_sphere_shape("ball", 0.1)
for _, name in ipairs { "left", "right" } do
  sim:add_body(name):add_part("p", ball, { position = vec3(name == "left" and 1 or -1, 0, 1) })
end
osc:on("/push", function(x) sim:body("right").parts[1]:apply_impulse(vec3(x, 0, rng:uniform(0, 1))) end)
)";

struct SmallTake {
  ShowFolder folder;
  std::string scene = folder.path("scripts/small.lua");
  std::string take = folder.path("small.take");
  std::vector<std::uint64_t> hashes;  // of each tick

  explicit SmallTake(int ticks) {
    log_to_stderr(false);
    folder.write("scripts/small.lua", kSmallScene);
    EngineOptions options = fast_options(scene);
    options.record = take;
    Show show(options);
    for (int i = 0; i < ticks; i++) {
      show.send("/push", 0.1 * i);
      show.ticks(1);
      hashes.push_back(show.engine.state_hash());
    }
    show.engine.end_take();
    show.engine.finish_saving();
  }
};

TEST(Take, ReplaysARandomSessionExactly) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "TakeSoak replays sessions of all commands");
  const ShowFolder folder;
  write_take_scene(folder);
  const std::string take = folder.path("wild.take");
  const std::uint64_t hash = record_take(folder, take, 400, 1);
  for (int i = 0; i < 2; i++) {
    const ReplayOutcome again = replay_take(take);
    ASSERT_EQ(again.error, "");
    EXPECT_FALSE(again.result.diverged_at.has_value()) << text_of(again.result);
    EXPECT_FALSE(again.result.truncated);
    EXPECT_GT(again.result.ticks, 200u);
    EXPECT_EQ(again.hash, hash);
  }
}

TEST(Take, IgnoresFilesOnTheDisk) {
  ShowFolder folder;
  write_take_scene(folder);
  const std::string take = folder.path("kept.take");
  const std::uint64_t hash = record_take(folder, take, 80, 2);
  for (const char* folder_name : {"scripts", "behaviors_lua", "urdf"})
    std::filesystem::remove_all(folder.path(folder_name));
  expect_replay(take, hash);
}

TEST(Take, CurrentScriptsDivergeAtTheirFirstDifference) {
  const SmallTake small(30);
  EXPECT_FALSE(replay_take(small.take, true).result.diverged_at.has_value());
  // identical until 0.25 s, when one body is pushed
  small.folder.write("scripts/small.lua",
                     std::string(kSmallScene) +
                         "sim:at(0.25, function() sim:body('right').parts[1]:apply_impulse(vec3(0, 0, 1)) end)\n");
  const ReplayOutcome exact = replay_take(small.take);
  EXPECT_FALSE(exact.result.diverged_at.has_value()) << text_of(exact.result);
  const ReplayOutcome diverged = replay_take(small.take, true);
  ASSERT_TRUE(diverged.result.diverged_at.has_value());
  // 15 ticks of 1/60 s are 0.25 s: the next one makes the call
  EXPECT_EQ(*diverged.result.diverged_at, 16u);
  EXPECT_EQ(diverged.result.diverged_body, "right");
  EXPECT_EQ(diverged.result.ticks, 30u) << "it continues to the end";
}

TEST(Take, RecordingInASessionBeginsWithAReset) {
  const ShowFolder folder;
  write_take_scene(folder);
  std::uint64_t hash = 0;
  {
    log_to_stderr(false);
    Show show(take_options(folder));
    play_random_inputs(show, folder, 60, 3);
    show.send("/preset/store", "kept");
    show.send("/scene/wind", 1.5);
    show.send("/preset/recall", "kept", 0.1);
    show.send("/transport/play");
    show.ticks(20);
    show.send("/take/record", "middle");
    show.ticks(1);
    EXPECT_EQ(show.engine.world().tick(), 0u) << "the scene starts again";
    // presets stored before the take are known in it
    show.send("/scene/wind", 2.5);
    show.ticks(1);
    show.send("/preset/recall", "kept");
    show.ticks(1);
    play_random_inputs(show, folder, 60, 4);
    show.send("/take/stop");
    show.ticks(1);
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  expect_replay(folder.path("takes/middle.take"), hash);
}

TEST(Take, RewindsToItsStartInASession) {
  const ShowFolder folder;
  write_take_scene(folder);
  std::uint64_t hash = 0;
  {
    log_to_stderr(false);
    Show show(take_options(folder));
    show.ticks(50);
    show.send("/take/record", "back");
    show.ticks(1);
    show.send("/push", 0.5);
    show.ticks(10);
    show.send("/transport/rewind", 5.0);
    show.ticks(1);
    EXPECT_EQ(show.engine.world().tick(), 1u) << "back to the start, and one tick";
    show.ticks(20);
    show.send("/take/stop");
    show.ticks(1);
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  expect_replay(folder.path("takes/back.take"), hash);
}

// An undo step must not contain values set by a stopped call: a replay doesn't execute that call.
TEST(Take, ExcludesStoppedCallsFromUndo) {
  const ShowFolder folder;
  write_take_scene(folder);
  folder.write("scripts/scene.lua", std::string(kTakeScene) + R"(
sim:on_step(function() if sim.tick == 20 then sim.gravity = vec3(0, 0, -8) end end)
)");
  EngineOptions options = take_options(folder);
  options.record = folder.path("undo.take");
  std::uint64_t hash = 0;
  {
    log_to_stderr(false);
    Show show(options);
    show.ticks(5);
    show.send("/physics/motor/damping", "arm1", 0.125);
    show.send("/loop", -3.0);
    show.ticks(30);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -8);
    show.send("/edit/undo");
    show.ticks(1);
    EXPECT_NE(show.read("/physics/body/arm1/motor/joint_1/damping"), 0.125);
    EXPECT_EQ(show.read("/physics/sim/gravity", 2), -8) << "the call that set it was rolled back";
    show.engine.end_take();
    hash = show.engine.state_hash();
    show.engine.finish_saving();
  }
  expect_replay(options.record, hash);
}

TEST(Take, ReplaysATruncatedFileToItsLastCompleteTick) {
  const SmallTake small(12);
  const std::string whole = file_bytes(small.take);
  const std::string cut = small.folder.path("cut.take");
  std::uint64_t last = 0;
  std::size_t first_playable_size = 0;
  for (std::size_t size = 0; size <= whole.size(); size++) {
    // count the complete ticks by the reader only; replay some of the files
    auto reader = TakeReader::from_stream(std::make_unique<std::istringstream>(whole.substr(0, size)), "cut.take");
    std::uint64_t ticks = 0;
    while (reader.ok()) {
      RecordedPass tick;
      if (!(*reader)->next(tick)) {
        EXPECT_FALSE((*reader)->next(tick)) << "also when called again";
        break;
      }
      ticks = tick.tick;
      first_playable_size = first_playable_size == 0 ? size : first_playable_size;
    }
    EXPECT_GE(ticks, last) << size;
    const bool is_new = ticks > last;
    last = ticks;
    if (reader.ok()) {
      EXPECT_EQ((*reader)->damage(), "") << size;
      EXPECT_EQ((*reader)->end().has_value(), size == whole.size()) << size;
    } else {
      EXPECT_TRUE(reader.error().starts_with("cut.take: ")) << reader.error();
    }
    if (!is_new && size % 211 != 0 && size != whole.size()) continue;
    std::ofstream(cut, std::ios::binary) << whole.substr(0, size);
    const ReplayOutcome played = replay_take(cut);
    EXPECT_EQ(played.error.empty(), first_playable_size != 0) << size << ": " << played.error;
    if (!played.error.empty()) continue;
    EXPECT_FALSE(played.result.diverged_at.has_value()) << size << ": " << text_of(played.result);
    EXPECT_EQ(played.result.truncated, size < whole.size()) << size;
    EXPECT_EQ(played.result.ticks, ticks) << size;
    if (ticks > 0) {
      EXPECT_EQ(played.hash, small.hashes[ticks - 1]) << size;
    }
  }
  EXPECT_EQ(last, 12u);
}

TEST(Take, DetectsDamagedBytes) {
  const SmallTake small(12);
  const std::string whole = file_bytes(small.take);
  const std::string bad = small.folder.path("bad.take");
  Random random(1, "bytes");
  int found = 0;
  for (int i = 0; i < 80; i++) {
    std::string bytes = whole;
    const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()));
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << static_cast<int>(random.uniform() * 8)));
    std::ofstream(bad, std::ios::binary) << bytes;
    const ReplayOutcome played = replay_take(bad);
    if (!played.error.empty()) {
      EXPECT_NE(played.error.find("bad.take: "), std::string::npos) << at;
      found++;
    } else if (!played.result.damage.empty() || played.result.truncated) {
      EXPECT_FALSE(played.result.diverged_at.has_value()) << at << ": " << text_of(played.result);
      found++;
    }
  }
  // a changed byte in the second line (information for people) is not detected
  EXPECT_GT(found, 60);
}

TEST(Take, ReplaysOldVersionsWithoutComparison) {
  log_to_stderr(false);
  const ReplayOutcome played = replay_take(LIMBER_SOURCE_DIR "/tests/fuzz/corpus/take/whole.take");
  ASSERT_EQ(played.error, "");
  EXPECT_GT(played.result.ticks, 5U);
  EXPECT_FALSE(played.result.diverged_at.has_value());
  EXPECT_FALSE(played.result.compared);
  EXPECT_NE(text_of(played.result).find(" ticks: nothing was compared, limber 0.1.0 ("), std::string::npos)
      << text_of(played.result);
  const SmallTake small(3);
  EXPECT_TRUE(replay_take(small.take).result.compared);
}

TEST(Take, ReportsDamageWhenTheReplayReachesIt) {
  const SmallTake small(40);
  std::string bytes = file_bytes(small.take);
  const auto whole = TakePlayer::open(small.take, false);
  ASSERT_TRUE(whole.ok());
  std::uint64_t ticks = 0;
  while ((*whole)->next()) ticks++;
  EXPECT_EQ((*whole)->result().damage, "");
  EXPECT_FALSE((*whole)->result().truncated);
  bytes[bytes.size() - 40] = static_cast<char>(bytes[bytes.size() - 40] ^ 1);  // in the last tick
  const std::string bad = small.folder.path("bad.take");
  std::ofstream(bad, std::ios::binary) << bytes;
  const auto player = TakePlayer::open(bad, false);
  ASSERT_TRUE(player.ok());
  for (std::uint64_t i = 1; i + 1 < ticks; i++) {
    EXPECT_EQ((*player)->result().damage, "") << i;
    EXPECT_FALSE((*player)->result().truncated) << i;
    ASSERT_TRUE((*player)->next()) << i;
  }
  ASSERT_TRUE((*player)->next());
  EXPECT_NE((*player)->result().damage, "");
  EXPECT_FALSE((*player)->next());
}

TEST(Take, RejectsInvalidTakeMessages) {
  const ShowFolder folder;
  folder.write("scripts/small.lua", kSmallScene);
  log_to_stderr(false);
  Show show(fast_options(folder.path("scripts/small.lua")));
  const auto is_rejected = [&](std::string address, auto... args) {
    show.sent_texts();
    show.send(std::move(address), args...);
    show.ticks(1);
    const std::vector<std::string> messages = show.sent_texts();
    return !messages.empty() && messages.front().starts_with("/error /take/");
  };
  EXPECT_TRUE(is_rejected("/take/stop"));
  for (const char* name : {"../up", "/abs", ".hidden", "a\nb"}) EXPECT_TRUE(is_rejected("/take/record", name)) << name;
  EXPECT_TRUE(is_rejected("/take/record", 5));
  EXPECT_FALSE(is_rejected("/take/record", "one"));
  EXPECT_TRUE(is_rejected("/take/record", "two"));
  EXPECT_FALSE(is_rejected("/take/stop"));
  EXPECT_FALSE(is_rejected("/take/record", "one"));
  EXPECT_FALSE(is_rejected("/take/stop"));
  show.engine.finish_saving();
  EXPECT_TRUE(std::filesystem::exists(folder.path("takes/one.take")));
  EXPECT_TRUE(std::filesystem::exists(folder.path("takes/one-2.take"))) << "no file is overwritten";
  EXPECT_FALSE(std::filesystem::exists(folder.path("takes/two.take")));
}

// A slow disk: an earlier take with the same name is not finished when the next one begins.
TEST(Take, TakesWithOneNameThatAreWrittenAtOnceAreBothKept) {
  const ShowFolder folder;
  const auto fail = [](const std::string& why) { ADD_FAILURE() << why; };
  const TakeWriter::Target target{folder.path("takes/one.take"), true};
  BackgroundWriter writer;
  {
    TakeWriter first(writer, target, {}, fail);
    ASSERT_TRUE(first.wait_until_open().ok());
    TakeWriter second(writer, target, {}, fail);
    ASSERT_TRUE(second.wait_until_open().ok());
    first.write("first");
    second.write("second");
  }
  for (const char* name : {"takes/one.take", "takes/one-2.take"})
    EXPECT_TRUE(std::filesystem::exists(folder.path(name))) << name;
}

TEST(Take, NeverRecordsThroughALinkOutOfTheShow) {
  const ShowFolder folder, outside;
  folder.write("scripts/small.lua", kSmallScene);
  log_to_stderr(false);
  Show show(fast_options(folder.path("scripts/small.lua")));
  const auto record = [&] {
    show.sent_texts();
    show.send("/take/record", "one");
    show.ticks(1);
    return show.sent_texts().front();
  };
  std::filesystem::create_directory_symlink(outside.path(""), folder.path("takes"));
  EXPECT_NE(record().find("takes/ is a link that leads out of the show's folder"), std::string::npos);
  show.engine.finish_saving();
  EXPECT_FALSE(std::filesystem::exists(outside.path("one.take")));
  std::filesystem::remove(folder.path("takes"));
  std::filesystem::create_directory(folder.path("recorded"));
  std::filesystem::create_directory_symlink(folder.path("recorded"), folder.path("takes"));
  EXPECT_EQ(record().find("/error"), std::string::npos);
  show.send("/take/stop");
  show.ticks(1);
  show.engine.finish_saving();
  EXPECT_TRUE(std::filesystem::exists(folder.path("recorded/one.take")));
}

TEST(Take, AFloodedTakeStaysSmall) {
  const ShowFolder folder;
  folder.write("scripts/small.lua", kSmallScene);
  EngineOptions options = fast_options(folder.path("scripts/small.lua"));
  options.record = folder.path("flood.take");
  Show show(options);
  Random random(1, "flood");
  const int seconds = 6;
  for (int i = 0; i < seconds * 60; i++) {
    for (int k = 0; k < 17; k++)
      show.send("/physics/body/left/part/p/friction", static_cast<double>(static_cast<float>(random.uniform())));
    show.ticks(1);
  }
  show.engine.end_take();
  show.engine.finish_saving();
  EXPECT_LT(file_bytes(options.record).size() * 60 / seconds, 1'000'000u);
  const ReplayOutcome again = replay_take(options.record);
  EXPECT_FALSE(again.result.diverged_at.has_value()) << text_of(again.result);
}

TEST(Take, RecordingDoesNotChangeTheSimulation) {
  const SmallTake small(20);
  Show show(fast_options(small.scene));
  for (int i = 0; i < 20; i++) {
    show.send("/push", 0.1 * i);
    show.ticks(1);
    EXPECT_EQ(show.engine.state_hash(), small.hashes[static_cast<std::size_t>(i)]) << i;
  }
}

}  // namespace
}  // namespace limber::engine::test
