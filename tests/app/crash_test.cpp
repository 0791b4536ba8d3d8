// Killed shows and stopped ones: what was saved is whole, and the next start has it.
#include "app/crash.h"

namespace limber::app_test {
namespace {

TEST(Crash, AKilledShowLosesNothingThatWasSaved) { crash(10, 10); }

struct Stopped {
  Folder folder;
  std::string scene = folder.file("scripts/s.lua", kCrashScene);
  osc_test::Client client;

  std::vector<std::string> words() const {
    return limber({scene, "--headless", "--osc-in", "127.0.0.1:0", "--osc-out", "off", "--query", "off"},
                  {"env", "XDG_STATE_HOME=" + folder.path() + "/state"});
  }
  void send(const Running& running, const Message& message) const {
    PacketBuffer buffer;
    const std::span<const char> bytes = encode_message(message, buffer);
    client.send({0x7f000001, static_cast<std::uint16_t>(std::stoi(running.behind("OSC in 127.0.0.1:")))},
                {bytes.data(), bytes.size()});
  }
  /// Waits for an answer of that address.
  bool answered(const std::string& address) const {
    while (const auto bytes = client.receive()) {
      const Result<Decoded> decoded = decode_packet(bytes->data(), bytes->size());
      for (const Message& message : decoded->messages) {
        if (message.address == address) return true;
      }
    }
    return false;
  }
  std::size_t kept() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() + "/state/limber/recovery"))
      count += entry.path().extension() == ".json" ? 1 : 0;
    return count;
  }
};

TEST(Crash, SignalsEndTheShowWithAllFilesWhole) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const Stopped show;
    Running running(show.words());
    ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
    show.send(running, {"/take/record", {Arg::of("last")}});
    ASSERT_TRUE(show.answered("/take/recording"));
    show.send(running, {"/scene/mark", {Arg::of(7.0)}});
    show.send(running, {"/preset/store", {Arg::of("last")}});
    show.send(running, {"/get", {Arg::of("/scene/mark")}});
    ASSERT_TRUE(show.answered("/scene/mark"));
    running.signal(signal);
    const Ran ran = running.finish();
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_TRUE(std::filesystem::is_empty(show.folder.path() + "/state/limber/recovery"));
    EXPECT_EQ(PresetFile(PresetFile::beside(show.scene)).load()->presets.size(), 1u);
    const Ran info = run({"take", "info", show.folder.path() + "/takes/last.take"});
    EXPECT_NE(info.out.find("end       whole; "), std::string::npos) << info.out << info.err;
  }
}

TEST(Crash, ATakeCanBePlayedFromTheMomentItsFileIsThere) {
  for (int round = 0; round < 3; round++) {
    const Stopped show;
    const std::string take = show.folder.path() + "/first.take";
    std::vector<std::string> words = show.words();
    words.insert(words.end(), {"--record", take});
    Running running(words);
    while (!std::filesystem::exists(take)) std::this_thread::yield();
    running.signal(SIGKILL);
    running.finish();
    const Ran again = run({"--replay", take, "--fast"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.err.find("every hash is the take's; the take was cut off there\n"), std::string::npos) << again.err;
  }
}

// it would be stopped after five seconds of computing, and that would be told
TEST(Crash, ASceneThatIsBeingReadHoldsUpNoEnd) {
  const Stopped show;
  Running running(show.words());
  ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
  show.folder.file("scripts/s.lua", "print('round and round')\nwhile true do end\n");
  ASSERT_TRUE(running.wait_for("round and round\n", true)) << running.err();
  running.signal(SIGTERM);
  const Ran ran = running.finish();
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.err.find("s.lua:2"), std::string::npos) << ran.err;
}

TEST(Crash, AStartSaysWhatTheLastRunHasLeft) {
  const Stopped show;
  {
    Running running(show.words());
    ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
    show.send(running, {"/scene/mark", {Arg::of(7.0)}});
    while (show.kept() == 0) {
      show.send(running, {"/get", {Arg::of("/scene/mark")}});
      ASSERT_TRUE(show.client.receive());
    }
    running.signal(SIGKILL);
    running.finish();
  }
  for (int i = 0; i < 2; i++) {
    Running running(show.words());
    ASSERT_TRUE(running.wait_for("playing headless")) << running.err();
    EXPECT_NE(running.err().find("the last run of this scene did not end well; 1 value of "), std::string::npos)
        << running.err();
    running.signal(SIGINT);
    EXPECT_EQ(running.finish().code, 0);
  }
  EXPECT_EQ(show.kept(), 1u);
}

}  // namespace
}  // namespace limber::app_test
