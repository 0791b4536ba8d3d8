// Killed and stopped shows: saved files are complete, and the next start restores them.
#include "app/crash.h"
#include "support/skip.h"

namespace limber::app::test {
namespace {

TEST(Crash, KilledShowLosesNoSavedData) { crash(10, 10); }

struct SignalledShow {
  TempFolder folder;
  std::string scene = folder.file("scripts/s.lua", kCrashScene);
  osc::test::Client client;

  std::vector<std::string> words() const {
    return limber_command({scene, "--headless", "--osc-in", "127.0.0.1:0", "--osc-out", "off", "--query", "off"},
                          {"env", "XDG_STATE_HOME=" + folder.path() + "/state"});
  }
  void send(const Process& running, const Message& message) const {
    osc::PacketBuffer buffer;
    const std::span<const char> bytes = osc::encode_message(message, buffer);
    client.send({0x7f000001, static_cast<std::uint16_t>(std::stoi(running.text_after("OSC in 127.0.0.1:")))},
                {bytes.data(), bytes.size()});
  }
  /// Waits for a reply with that address.
  bool wait_for_reply(const std::string& address) const {
    while (const auto bytes = client.receive()) {
      const Result<osc::Decoded> decoded = osc::decode_packet(bytes->data(), bytes->size());
      for (const Message& message : decoded->messages) {
        if (message.address == address) return true;
      }
    }
    return false;
  }
  std::size_t recovery_files() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() + "/state/limber/recovery"))
      count += entry.path().extension() == ".json" ? 1 : 0;
    return count;
  }
};

TEST(Crash, SignalsCompleteAllFiles) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const SignalledShow show;
    Process running(show.words());
    ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
    show.send(running, {"/take/record", {Arg::of("last")}});
    ASSERT_TRUE(show.wait_for_reply("/take/recording"));
    show.send(running, {"/scene/mark", {Arg::of(7.0)}});
    show.send(running, {"/preset/store", {Arg::of("last")}});
    show.send(running, {"/get", {Arg::of("/scene/mark")}});
    ASSERT_TRUE(show.wait_for_reply("/scene/mark"));
    // a clean exit removes the values that were saved for recovery
    while (show.recovery_files() == 0) {
      show.send(running, {"/get", {Arg::of("/scene/mark")}});
      ASSERT_TRUE(show.client.receive());
    }
    running.signal(signal);
    const RunResult result = running.finish();
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::is_empty(show.folder.path() + "/state/limber/recovery"));
    EXPECT_EQ(engine::PresetFile(engine::PresetFile::path_for(show.scene)).load()->presets.size(), 1u);
    const RunResult info = run({"take", "info", show.folder.path() + "/takes/last.take"});
    EXPECT_NE(info.out.find("end       complete; "), std::string::npos) << info.out << info.err;
  }
}

TEST(Crash, TakeIsValidAsSoonAsItExists) {
  for (int round = 0; round < 3; round++) {
    const SignalledShow show;
    const std::string take = show.folder.path() + "/first.take";
    std::vector<std::string> words = show.words();
    words.insert(words.end(), {"--record", take});
    Process running(words);
    while (!std::filesystem::exists(take)) std::this_thread::yield();
    running.signal(SIGKILL);
    running.finish();
    const RunResult again = run({"--replay", take, "--fast"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.err.find("all hashes match the take; the take was cut off there\n"), std::string::npos)
        << again.err;
  }
}

// loading would be aborted after five seconds, with an error
TEST(Crash, LoadingASceneDoesNotDelayTheEnd) {
  const SignalledShow show;
  Process running(show.words());
  ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
  show.folder.file("scripts/s.lua", "print('round and round')\nwhile true do end\n");
  ASSERT_TRUE(running.wait_for("round and round\n", true)) << running.err();
  running.signal(SIGTERM);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err.find("s.lua:2"), std::string::npos) << result.err;
}

TEST(Crash, StartReportsRecoverableValues) {
  const SignalledShow show;
  {
    Process running(show.words());
    ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
    show.send(running, {"/scene/mark", {Arg::of(7.0)}});
    while (show.recovery_files() == 0) {
      show.send(running, {"/get", {Arg::of("/scene/mark")}});
      ASSERT_TRUE(show.client.receive());
    }
    running.signal(SIGKILL);
    running.finish();
  }
  for (int i = 0; i < 2; i++) {
    Process running(show.words());
    ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
    EXPECT_NE(running.err().find("the last run of this scene did not exit cleanly; 1 value of "), std::string::npos)
        << running.err();
    running.signal(SIGINT);
    EXPECT_EQ(running.finish().code, 0);
  }
  EXPECT_EQ(show.recovery_files(), 1u);
}

}  // namespace
}  // namespace limber::app::test
