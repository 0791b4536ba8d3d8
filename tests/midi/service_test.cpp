// Devices that come and go, learning, and the file of the map.
#include "net/midi/service.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "base/log/log.h"
#include "midi/midi_rig.h"

namespace limber::midi::test {
namespace {

MidiOptions on(const std::string& ports = "") {
  MidiOptions options;
  options.use = MidiOptions::Use::on;
  options.ports = ports;
  return options;
}

// The lines of the log since `seen` about MIDI.
std::vector<std::string> log_since_number(std::uint64_t seen) {
  std::vector<std::string> lines;
  for (const LogLine& line : log_since(seen)) {
    if (line.text.find("MIDI") != std::string::npos) lines.push_back(line.text);
  }
  return lines;
}

bool sent(MidiRig& rig, const std::string& text) {
  const std::vector<std::string> texts = rig.show.sent_texts();
  return std::ranges::any_of(texts, [&](const std::string& line) { return line.find(text) != line.npos; });
}

TEST(MidiDevices, AreOpenedOnDemandOnly) {
  MidiRig rig;
  rig.pass(5000);
  EXPECT_EQ(rig.devices.lists, 0);
  EXPECT_FALSE(rig.report().on);
  rig.send("/midi/learn", "/scene/wind");
  rig.pass(20);
  EXPECT_TRUE(rig.devices.receivers.contains(kNano));
  rig.send("/midi/learn");
  rig.pass(20);
  EXPECT_FALSE(rig.devices.receivers.contains(kNano));
}

TEST(MidiDevices, AreOpenedForAMap) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind"})"));
  EXPECT_TRUE(rig.devices.receivers.contains(kNano));
  EXPECT_EQ(rig.devices.open_outputs[kNano], 1);
}

TEST(MidiDevices, OnlyThoseOfTheOptionAreOpened) {
  MidiRig rig("", on("LAUNCH"));
  rig.devices.plug_in("Launchpad:Launchpad MIDI 1");
  rig.pass(1000);
  EXPECT_TRUE(rig.devices.receivers.contains("Launchpad:Launchpad MIDI 1"));
  EXPECT_FALSE(rig.devices.receivers.contains(kNano));
}

TEST(MidiDevices, TheLoopOfAlsaIsOpenedByNameOnly) {
  constexpr const char* kThrough = "Midi Through:Midi Through Port-0";
  MidiRig all("", on());
  all.devices.plug_in(kThrough);
  all.pass(1000);
  EXPECT_FALSE(all.devices.receivers.contains(kThrough));
  MidiRig named("", on("through"));
  named.devices.plug_in(kThrough);
  named.pass(1000);
  EXPECT_TRUE(named.devices.receivers.contains(kThrough));
}

TEST(MidiDevices, OneThatReturnsIsOpenedAgain) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  const std::uint64_t seen = log_newest();
  rig.devices.unplug(kNano);
  rig.pass(5000);
  EXPECT_FALSE(rig.devices.receivers.contains(kNano));
  EXPECT_FALSE(rig.report().devices.at(0).present);
  EXPECT_EQ(
      log_since_number(seen),
      (std::vector<std::string>{"MIDI: nanoKONTROL2:nanoKONTROL2 MIDI 1 was unplugged. It is opened again when it "
                                "returns"}));
  rig.devices.received(kNano);
  rig.devices.plug_in(kNano);
  rig.pass(1100);
  EXPECT_EQ(log_since_number(seen).back(), "MIDI: nanoKONTROL2:nanoKONTROL2 MIDI 1 is back");
  EXPECT_EQ(rig.devices.received(kNano), (Bytes{0xb0, 7, 64})) << "its faders get the values again";
  rig.move({0xb0, 7, 127});
  EXPECT_EQ(rig.read("/scene/wind"), 1);
}

TEST(MidiDevices, AButtonIsReleasedWhenItsDeviceIsUnplugged) {
  MidiRig rig(map_of(R"({"kind": "note", "number": 36, "address": "/scene/mist", "mode": "momentary"})"));
  rig.move({0x90, 36, 100});
  EXPECT_EQ(rig.read("/scene/mist"), 1);
  rig.devices.unplug(kNano);
  rig.pass(1000);
  rig.settle();
  EXPECT_EQ(rig.read("/scene/mist"), 0);
}

TEST(MidiDevices, ABusyOneIsReportedOnceAndOpenedLater) {
  const std::uint64_t seen = log_newest();
  MidiRig rig("", on());
  rig.devices.plug_in("Busy");
  rig.devices.faults["Busy"] = "in use";
  rig.pass(5000);
  const std::vector<std::string> lines = log_since_number(seen);
  EXPECT_EQ(std::ranges::count(lines,
                               "MIDI: Busy can't be opened: in use. Close other programs that use it; retrying "
                               "every second"),
            1);
  rig.devices.faults.clear();
  rig.pass(1100);
  EXPECT_TRUE(rig.devices.receivers.contains("Busy"));
}

TEST(MidiDevices, AMachineWithoutMidiPlaysOn) {
  const std::uint64_t seen = log_newest();
  MidiRig rig("", on());
  rig.devices.fault = "there is no sequencer";
  rig.pass(5000);
  const std::vector<std::string> lines = log_since_number(seen);
  EXPECT_EQ(std::ranges::count(lines,
                               "MIDI is not available: there is no sequencer. Limber plays on, and looks for it "
                               "every second"),
            1);
  EXPECT_EQ(rig.report().problem, "there is no sequencer");
  rig.devices.fault.clear();
  rig.pass(1100);
  EXPECT_EQ(rig.report().problem, "");
}

TEST(MidiDevices, AMissingNameListsTheOthers) {
  const std::uint64_t seen = log_newest();
  MidiRig rig("", on("faderfox"));
  rig.pass(3000);
  EXPECT_EQ(log_since_number(seen),
            (std::vector<std::string>{"MIDI: no port has 'faderfox' in its name; there are: nanoKONTROL2:nanoKONTROL2 "
                                      "MIDI 1. It is opened as soon as it is plugged in"}));
}

TEST(MidiLearn, TheMovedControlSetsTheAddress) {
  MidiRig rig("", on());
  rig.send("/midi/learn", "/scene/wind");
  EXPECT_TRUE(sent(rig, "/midi/learning /scene/wind"));
  EXPECT_EQ(rig.report().learning, "/scene/wind");
  rig.move({0xb4, 7, 10});
  EXPECT_EQ(rig.read("/scene/wind"), 0.5) << "it doesn't act while it is learned";
  rig.pass(200);
  EXPECT_TRUE(sent(rig, "/midi/learned /scene/wind cc 7, channel 5, nanoKONTROL2:nanoKONTROL2 MIDI 1"));
  EXPECT_EQ(rig.report().learning, "");
  const Result<MidiMap> saved = parse_midi_map(rig.map_text());
  ASSERT_TRUE(saved.ok()) << saved.error();
  ASSERT_EQ(saved->size(), 1u);
  EXPECT_EQ(saved->at(0).address, "/scene/wind");
  EXPECT_EQ(saved->at(0).channel, 5);
  EXPECT_EQ(saved->at(0).number, 7);
  rig.move({0xb4, 7, 63, 7, 127});
  EXPECT_EQ(rig.read("/scene/wind"), 1);
}

TEST(MidiLearn, FindsTheKindOfControl) {
  struct Case {
    Bytes bytes;
    const char* control;
  };
  const Case cases[] = {
      {{0xb0, 7, 1, 39, 5}, "cc14 7, channel 1"},
      {{0xb0, 7, 1, 40, 5}, "cc 7, channel 1"},
      {{0xb0, 99, 1, 98, 2, 6, 3, 38, 4}, "nrpn 130, channel 1"},
      {{0x90, 36, 90, 36, 0}, "note 36, channel 1"},
      {{0xd0, 5, 0x91, 40, 60, 0xd1, 7}, "note 40, channel 2"},
      {{0xd2, 5}, "pressure, channel 3"},
      {{0xe0, 5, 7}, "pitch_bend, channel 1"},
      {{0xb0, 123, 0, 0xc0, 3}, "program 3, channel 1"},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.control);
    MidiRig rig("", on());
    rig.send("/midi/learn", "/scene/wind");
    rig.move(each.bytes);
    rig.pass(200);
    EXPECT_TRUE(sent(rig, std::string("/midi/learned /scene/wind ") + each.control));
  }
}

TEST(MidiLearn, ReplacesTheControlOfTheAddress) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind"},
                        {"kind": "cc", "number": 9, "address": "/scene/waves"})"));
  rig.send("/midi/learn", "/scene/wind", "relative");
  rig.move({0xb0, 8, 10});
  rig.pass(200);
  const Result<MidiMap> saved = parse_midi_map(rig.map_text());
  ASSERT_TRUE(saved.ok()) << saved.error();
  ASSERT_EQ(saved->size(), 2u);
  EXPECT_EQ(saved->at(0).address, "/scene/waves");
  EXPECT_EQ(saved->at(1).number, 8);
  EXPECT_EQ(saved->at(1).mode, ControlMode::relative);
}

TEST(MidiLearn, WideRangesAreNarrowedAroundTheValue) {
  MidiRig rig("", on());
  rig.send("/midi/learn", "/physics/sim/gravity", 3);
  rig.move({0xb0, 8, 10});
  rig.pass(200);
  const Result<MidiMap> saved = parse_midi_map(rig.map_text());
  ASSERT_TRUE(saved.ok()) << saved.error();
  ASSERT_EQ(saved->size(), 1u) << rig.map_text();
  EXPECT_EQ(saved->at(0).component, 3);
  EXPECT_EQ(saved->at(0).range, (std::array{-2 * 9.81, 0.0}));
}

TEST(MidiLearn, BadRequestsNameTheFault) {
  MidiRig rig("", on());
  rig.send("/midi/learn", "wind");
  EXPECT_TRUE(sent(rig, "/error /midi/learn 'wind' is not an address; it must begin with /"));
  rig.send("/midi/learn", "/physics/sim/time");
  EXPECT_TRUE(sent(rig, "/physics/sim/time is read-only"));
  rig.send("/midi/learn", "/physics/sim/gravity");
  EXPECT_TRUE(sent(rig, "set \"component\" to a number from 1 to 3"));
  rig.send("/midi/learn", "/scene/wind", "sideways");
  EXPECT_TRUE(sent(rig, "unknown mode 'sideways'"));
  rig.send("/midi/learn", 7);
  EXPECT_TRUE(sent(rig, "takes an address"));
  rig.send("/midi/forget", "/scene/wind");
  EXPECT_TRUE(sent(rig, "no control sets /scene/wind"));
  rig.send("/midi/forget", "/scene/wind", 1e300);
  EXPECT_TRUE(sent(rig, "no control sets /scene/wind"));
  EXPECT_EQ(rig.report().learning, "");
}

TEST(MidiLearn, CanBeCanceled) {
  MidiRig rig("", on());
  rig.send("/midi/learn", "/scene/wind");
  rig.send("/midi/learn");
  EXPECT_EQ(rig.report().learning, "");
  rig.move({0xb0, 7, 1});
  rig.pass(500);
  EXPECT_EQ(rig.map_text(), "");
}

TEST(MidiLearn, ForgetRemovesTheEntries) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  rig.send("/midi/forget", "/scene/wind");
  EXPECT_TRUE(sent(rig, "/midi/forgotten /scene/wind"));
  EXPECT_TRUE(parse_midi_map(rig.map_text()).value().empty());
  rig.devices.send(kNano, {0xb0, 7, 127});
  rig.settle();
  EXPECT_EQ(rig.read("/scene/wind"), 0.5);
}

TEST(MidiMapFile, IsReadAgainWhenItIsSaved) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  rig.write_map(map_of(R"({"kind": "cc", "number": 8, "address": "/scene/wind", "takeover": "jump"})"));
  rig.pass(600);
  rig.move({0xb0, 7, 0, 8, 127});
  EXPECT_EQ(rig.read("/scene/wind"), 1);
}

TEST(MidiMapFile, AnErrorKeepsTheMap) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  rig.write_map("{");
  rig.pass(600);
  EXPECT_NE(rig.report().file_error.find("scene.midi.json: line 1: not valid JSON"), std::string::npos)
      << rig.report().file_error;
  rig.move({0xb0, 7, 127});
  EXPECT_EQ(rig.read("/scene/wind"), 1);
  // a file that is being edited is not overwritten
  rig.send("/midi/learn", "/scene/waves");
  rig.move({0xb0, 9, 1});
  rig.pass(200);
  EXPECT_TRUE(sent(rig, "Correct the file, then learn again"));
  EXPECT_EQ(rig.map_text(), "{");
}

TEST(MidiMapFile, AnotherSceneHasAnotherMap) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  engine::test::SceneFile other(kMidiScene);
  rig.service->set_scene(other.path());
  rig.pass(600);
  EXPECT_TRUE(rig.report().entries.empty());
}

TEST(MidiService, ReportsItsStateAsProperties) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  rig.move({0xb0, 7, 127});
  rig.pass(200);
  rig.settle();
  rig.send("/get", "/midi/*");
  const std::vector<std::string> texts = rig.show.sent_texts();
  const auto has = [&](const std::string& text) { return std::ranges::find(texts, text) != texts.end(); };
  EXPECT_TRUE(has("/midi/devices nanoKONTROL2:nanoKONTROL2 MIDI 1\tin and out"));
  EXPECT_TRUE(has("/midi/entries /scene/wind\tcc 7\tabsolute"));
  EXPECT_TRUE(has("/midi/last_event cc 7 = 127, channel 1, nanoKONTROL2:nanoKONTROL2 MIDI 1"));
}

TEST(MidiService, OffRejectsRequests) {
  MidiOptions options;
  options.use = MidiOptions::Use::off;
  MidiRig rig("", options);
  rig.send("/midi/learn", "/scene/wind");
  EXPECT_TRUE(sent(rig, "MIDI is off"));
}

// The thread: bytes arrive from another one, as from RtMidi.
TEST(MidiService, ItsThreadSetsValues) {
  engine::test::SceneFile scene(kMidiScene);
  std::ofstream(MapFile::path_for(scene.path()))
      << map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})");
  engine::test::Show show(scene.path());
  FakeDevices devices;
  devices.plug_in(kNano);
  MidiService service(show.link, on(), std::make_unique<FakePorts>(devices));
  service.set_scene(scene.path());
  service.start();
  const auto is_open = [&] {
    const engine::MidiReport report = show.link.midi.report();
    return !report.devices.empty() && !report.entries.empty() && report.entries[0].state == "absolute";
  };
  while (!is_open()) show.ticks(1);
  std::thread([&] { devices.send(kNano, {0xb0, 7, 127}); }).join();
  while (show.read("/scene/wind") != 1) show.ticks(1);
  service.stop();
  EXPECT_TRUE(devices.receivers.empty());
  EXPECT_EQ(devices.open_outputs[kNano], 0);
}

}  // namespace
}  // namespace limber::midi::test
