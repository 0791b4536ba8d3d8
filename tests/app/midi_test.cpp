// MIDI of the program: its options, and machines without MIDI.
#include <csignal>

#include "app/playing.h"
#include "base/system/net/midi_system.h"

namespace limber::app::test {
namespace {

constexpr const char* kMidiFault =
    "MIDI is not available: this machine has neither the ALSA sequencer nor a JACK server";

// Whether the machine has MIDI: with it, there is no fault.
bool has_midi() { return system::find_midi_system() != system::MidiSystem::none; }

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) count++;
  return count;
}

TEST(PlayMidi, AMachineWithoutMidiPlaysOn) {
  const TempFolder folder;
  const std::string scene = folder.file("scene.lua", "sim:every(0.1, function() print('on') end)");
  Process running(
      limber_command({"play", scene, "--headless", "--osc-in", "off", "--osc-out", "off", "--query", "off", "--midi"}));
  EXPECT_TRUE(running.wait_for(has_midi() ? "playing headless" : kMidiFault)) << running.err();
  EXPECT_TRUE(running.wait_for("on\n", true));
  running.signal(SIGINT);
  const RunResult result = running.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(count_of(result.err, kMidiFault), has_midi() ? 0u : 1u) << result.err;
  EXPECT_EQ(result.err.find("RtMidi"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("ALSA lib"), std::string::npos) << result.err;
}

TEST(PlayMidi, AShowWithoutAMapOpensNothing) {
  const TempFolder folder;
  const std::string scene = folder.file("scene.lua", "sim:after(0.2, function() print('on') end)");
  const RunResult result =
      run({"play", scene, "--headless", "--osc-in", "off", "--osc-out", "off", "--query", "off", "--duration", "0.3"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err.find("MIDI"), std::string::npos) << result.err;
}

TEST(PlayMidi, ASceneBehindTheOptionIsNoDevice) {
  const TempFolder folder;
  const std::string scene = folder.file("scene.lua", "");
  const RunResult result = run({"play", "--midi", scene});
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_NE(result.err.find("is a file, not a MIDI device; write it before --midi, or write --midi all"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(run({"play", "--midi", "all", scene, "--fast", "--ticks", "1"}).code, 0);
  EXPECT_EQ(run({"play", scene, "--fast", "--ticks", "1", "--midi", "off"}).err.find("MIDI"), std::string::npos);
}

}  // namespace
}  // namespace limber::app::test
