// The list of MIDI devices and controls, and the menu that learns one.
#include <fmt/format.h>

#include "panel/rig.h"

namespace limber::panel::test {
namespace {

/// A panel with MIDI whose requests are noted.
struct MidiPanelFixture {
  MidiPanelFixture() {
    panel.show.link.midi.set_available(true);
    panel.show.link.on_midi_request = [this](const Message& message, const CommandOrigin& origin) {
      requests.push_back(engine::test::text_of(message));
      EXPECT_EQ(origin.source, CommandSource::panel);
    };
  }
  void set(const engine::MidiReport& report) {
    panel.show.link.midi.set(report);
    panel.sync();
  }

  PanelFixture panel;
  std::vector<std::string> requests;
};

engine::MidiReport report_with_controls() {
  engine::MidiReport report;
  report.on = true;
  report.devices = {{"nanoKONTROL2", true, true, true}, {"Launchpad", false, false, false}};
  report.entries = {{"cc 7, channel 1, nanoKONTROL2", "/scene/rate", "absolute", false},
                    {"cc 8", "/physics/sim/gravity [3]", "has no limits", true}};
  report.last_event = "cc 7 = 64, channel 1, nanoKONTROL2";
  return report;
}

TEST(PanelMidi, ListsDevicesAndControls) {
  MidiPanelFixture midi;
  midi.panel.click("tab:midi");
  midi.set(report_with_controls());
  for (const char* name : {"midi.device:nanoKONTROL2", "midi.device:Launchpad", "midi.entry:/scene/rate",
                           "midi.entry:/physics/sim/gravity [3]", "midi.state"})
    EXPECT_TRUE(midi.panel.is_visible(name)) << name;
  EXPECT_FALSE(midi.panel.is_visible("midi.cancel"));
}

TEST(PanelMidi, ForgetsAControl) {
  MidiPanelFixture midi;
  midi.panel.click("tab:midi");
  midi.set(report_with_controls());
  midi.panel.click("midi.forget:/scene/rate");
  midi.panel.click("midi.forget:/physics/sim/gravity [3]");
  EXPECT_EQ(midi.requests,
            (std::vector<std::string>{"/midi/forget /scene/rate", "/midi/forget /physics/sim/gravity 3"}));
}

TEST(PanelMidi, CancelsLearning) {
  MidiPanelFixture midi;
  midi.panel.click("tab:midi");
  engine::MidiReport report = report_with_controls();
  report.learning = "/scene/rate";
  midi.set(report);
  midi.panel.click("midi.cancel");
  EXPECT_EQ(midi.requests, std::vector<std::string>{"/midi/learn"});
}

TEST(PanelMidi, TheMenuOfAValueLearns) {
  MidiPanelFixture midi;
  midi.panel.click("/scene/rate", 1);
  midi.panel.click("menu:midi_learn");
  EXPECT_EQ(midi.requests, std::vector<std::string>{"/midi/learn /scene/rate"});
}

TEST(PanelMidi, WithoutMidiTheMenuHasNoEntry) {
  PanelFixture panel;
  panel.click("/scene/rate", 1);
  EXPECT_TRUE(panel.is_visible("menu:copy_address"));
  EXPECT_FALSE(panel.is_visible("menu:midi_learn"));
}

}  // namespace
}  // namespace limber::panel::test
