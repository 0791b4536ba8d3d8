// From the bytes of a device to the values of a show: modes, ranges, pickup, feedback.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <string>
#include <vector>

#include "midi/midi_rig.h"

namespace limber::midi::test {
namespace {

constexpr const char* kFader = R"({"kind": "cc", "number": 7, "address": "/scene/wind"})";

TEST(MidiMapping, AControlSetsAValueOverItsRange) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/waves", "takeover": "jump"})"));
  rig.move({0xb0, 7, 127});
  EXPECT_EQ(rig.read("/scene/waves"), 8);
  rig.move({0xb0, 7, 0});
  EXPECT_EQ(rig.read("/scene/waves"), 0);
  rig.move({0xb3, 7, 64});
  EXPECT_DOUBLE_EQ(rig.read("/scene/waves"), 8 * 64 / 127.0) << "any channel";
  rig.move({0xb0, 8, 1});
  EXPECT_DOUBLE_EQ(rig.read("/scene/waves"), 8 * 64 / 127.0) << "another control";
}

TEST(MidiMapping, RangesMayDescend) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/waves", "range": [6, 2], "takeover": "jump"})"));
  rig.move({0xb0, 7, 127});
  EXPECT_EQ(rig.read("/scene/waves"), 2);
  rig.move({0xb0, 7, 0});
  EXPECT_EQ(rig.read("/scene/waves"), 6);
}

TEST(MidiMapping, FourteenBitsAreFine) {
  MidiRig rig(map_of(R"({"kind": "cc14", "number": 1, "address": "/scene/wind", "takeover": "jump"})"));
  rig.move({0xb0, 1, 64, 33, 5});
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), (64 * 128 + 5) / 16383.0);
}

TEST(MidiMapping, ParametersAndPitchBend) {
  MidiRig rig(map_of(R"({"kind": "nrpn", "number": 130, "address": "/scene/wind", "takeover": "jump"},
                        {"kind": "pitch_bend", "address": "/scene/waves", "takeover": "jump"})"));
  rig.move({0xb0, 99, 1, 98, 2, 6, 100, 38, 7});
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), (100 * 128 + 7) / 16383.0);
  rig.move({0xe0, 0, 32});
  EXPECT_DOUBLE_EQ(rig.read("/scene/waves"), 8 * 4096 / 16383.0);
}

// The value is 0.5, position 63.5: the fader passes it between 60 and 70.
TEST(MidiMapping, PickupWaitsUntilTheControlPassesTheValue) {
  MidiRig rig(map_of(kFader));
  rig.move({0xb0, 7, 10});
  EXPECT_EQ(rig.read("/scene/wind"), 0.5);
  EXPECT_EQ(rig.report().entries.at(0).state, "move it past 0.5");
  rig.move({0xb0, 7, 60});
  EXPECT_EQ(rig.read("/scene/wind"), 0.5);
  rig.move({0xb0, 7, 70});
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), 70 / 127.0);
  rig.move({0xb0, 7, 10});
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), 10 / 127.0) << "it holds the value now";
  EXPECT_EQ(rig.report().entries.at(0).state, "absolute");
}

TEST(MidiMapping, PickupBeginsAgainAfterAnotherSource) {
  MidiRig rig(map_of(kFader));
  rig.move({0xb0, 7, 64});  // nearer than one step
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), 64 / 127.0);
  rig.send("/scene/wind", 0.9);
  rig.move({0xb0, 7, 50});
  EXPECT_EQ(rig.read("/scene/wind"), 0.9);
  rig.move({0xb0, 7, 120});
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), 120 / 127.0);
}

TEST(MidiMapping, AFastMovementHoldsTheValueBeforeItIsExecuted) {
  MidiRig rig(map_of(kFader));
  rig.move({0xb0, 7, 64});
  for (const int position : {80, 100, 120}) {
    rig.devices.send(kNano, {0xb0, 7, static_cast<std::uint8_t>(position)});
    rig.pass(2);
  }
  rig.settle();
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), 120 / 127.0);
}

struct Encoder {
  const char* mode;
  std::uint8_t up_two, down_three;
};

TEST(MidiMapping, RelativeEncodersStep) {
  for (const Encoder& encoder :
       {Encoder{"relative", 2, 125}, Encoder{"relative_offset", 66, 61}, Encoder{"relative_sign", 2, 67}}) {
    SCOPED_TRACE(encoder.mode);
    MidiRig rig(map_of(std::string(R"({"kind": "cc", "number": 1, "address": "/scene/waves", "mode": ")") +
                       encoder.mode + R"(", "step": 0.25},
                       {"kind": "cc", "number": 2, "address": "/physics/sim/substeps", "mode": ")" +
                       encoder.mode + "\"}"));
    rig.move({0xb0, 1, encoder.up_two});
    EXPECT_DOUBLE_EQ(rig.read("/scene/waves"), 2.5);
    rig.move({0xb0, 1, encoder.down_three, 1, encoder.down_three});
    EXPECT_DOUBLE_EQ(rig.read("/scene/waves"), 1) << "steps of a batch add up";
    for (int i = 0; i < 5; i++) rig.move({0xb0, 1, encoder.down_three});
    EXPECT_EQ(rig.read("/scene/waves"), 0);
    const double substeps = rig.read("/physics/sim/substeps");
    rig.move({0xb0, 2, encoder.up_two});
    EXPECT_EQ(rig.read("/physics/sim/substeps"), substeps + 2) << "whole steps of a whole number";
  }
}

TEST(MidiMapping, ButtonsToggleHoldAndTrigger) {
  MidiRig rig(map_of(R"({"kind": "note", "number": 36, "address": "/scene/mist"},
                        {"kind": "cc", "number": 20, "address": "/scene/waves", "mode": "momentary", "range": [1, 7]},
                        {"kind": "note", "number": 37, "address": "/note", "mode": "trigger", "values": ["a", 2]},
                        {"kind": "program", "number": 5, "address": "/note", "values": ["p"], "mode": "trigger"})"));
  rig.move({0x90, 36, 100});
  EXPECT_EQ(rig.read("/scene/mist"), 1);
  rig.move({0x80, 36, 0});
  EXPECT_EQ(rig.read("/scene/mist"), 1);
  rig.move({0x90, 36, 100, 36, 0});
  EXPECT_EQ(rig.read("/scene/mist"), 0);
  rig.move({0xb0, 20, 127});
  EXPECT_EQ(rig.read("/scene/waves"), 7);
  rig.move({0xb0, 20, 0});
  EXPECT_EQ(rig.read("/scene/waves"), 1);
  rig.move({0x90, 37, 1, 37, 0, 0xc0, 5, 5, 4});
  EXPECT_EQ(rig.show.sent_texts(), (std::vector<std::string>{"/heard a 2", "/heard p", "/heard p"}));
}

TEST(MidiMapping, ANoteScalesItsVelocity) {
  MidiRig rig(map_of(R"({"kind": "note", "number": 36, "address": "/scene/wind", "mode": "absolute"})"));
  rig.move({0x90, 36, 127});
  EXPECT_EQ(rig.read("/scene/wind"), 1) << "keys need no pickup";
}

TEST(MidiMapping, ActionsAreTriggered) {
  MidiRig rig(map_of(R"({"kind": "note", "number": 36, "address": "/transport/pause"})"));
  rig.move({0x90, 36, 100});
  EXPECT_EQ(rig.read("/physics/sim/paused"), 1);
}

TEST(MidiMapping, TwoControlsSetOneVector) {
  MidiRig rig(map_of(
      R"({"kind": "cc", "number": 1, "address": "/physics/sim/gravity", "component": 1, "range": [0, 127], "takeover": "jump"},
         {"kind": "cc", "number": 2, "address": "/physics/sim/gravity", "component": 2, "range": [0, 127], "takeover": "jump"})"));
  rig.move({0xb0, 1, 5, 2, 6});
  EXPECT_EQ(rig.show.read("/physics/sim/gravity", 0), 5);
  EXPECT_EQ(rig.show.read("/physics/sim/gravity", 1), 6);
}

TEST(MidiMapping, UnusableEntriesNameTheirFault) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 1, "address": "/physics/sim/gravity"},
                        {"kind": "cc", "number": 2, "address": "/physics/sim/time"},
                        {"kind": "cc", "number": 3, "address": "/scene/wind", "mode": "trigger"})"));
  rig.move({0xb0, 1, 5, 2, 6, 3, 127});
  const engine::MidiReport report = rig.report();
  EXPECT_EQ(report.entries.at(0).state,
            "/physics/sim/gravity has 3 numbers; set \"component\" to a number from 1 to 3");
  EXPECT_TRUE(report.entries.at(0).problem);
  EXPECT_EQ(report.entries.at(1).state, "/physics/sim/time is read-only; name a setting");
  EXPECT_EQ(report.entries.at(2).state, "/scene/wind needs a value; give the entry its \"values\", such as [1]");
}

// A device that sends without end: one message per control and batch.
TEST(MidiMapping, AFloodBecomesOneMessagePerBatch) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  Bytes flood = {0xb0};
  for (int i = 0; i < 100; i++) flood.insert(flood.end(), {7, static_cast<std::uint8_t>(i)});
  for (int i = 0; i < 20; i++) rig.devices.send(kNano, flood);
  rig.service->update();
  std::vector<engine::Command> commands;
  rig.show.link.command_queue.drain(commands);
  ASSERT_EQ(commands.size(), 1u);
  ASSERT_EQ(commands[0].messages.size(), 1u);
  EXPECT_DOUBLE_EQ(commands[0].messages[0].args[0].number, 99 / 127.0);
  EXPECT_EQ(sender_text(commands[0].origin), "midi");
}

TEST(MidiMapping, UndoTakesBackAWholeMovement) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  for (const int position : {70, 80, 90}) {
    rig.devices.send(kNano, {0xb0, 7, static_cast<std::uint8_t>(position)});
    rig.pass(20);
    rig.show.ticks(2);
  }
  rig.settle();
  rig.pass(1000);
  rig.move({0xb0, 7, 100});
  rig.show.ticks(60);  // steps that another controller extends are not undone
  rig.send("/edit/undo");
  EXPECT_DOUBLE_EQ(rig.read("/scene/wind"), 90 / 127.0);
  rig.send("/edit/undo");
  EXPECT_EQ(rig.read("/scene/wind"), 0.5);
}

TEST(MidiMapping, ATakeReplaysWithoutADevice) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"), {}, "a.take");
  for (const int position : {70, 80, 90}) rig.move({0xb0, 7, static_cast<std::uint8_t>(position)});
  rig.send("/midi/learn", "/scene/waves");
  rig.send("/take/stop");
  rig.show.engine.finish_saving();
  engine::EngineOptions options = engine::test::fast_options();
  options.replay = rig.take_path("a.take");
  engine::test::Show replay(std::move(options));
  int requests = 0;
  replay.link.on_midi_request = [&](const Message&, const CommandOrigin&) { requests++; };
  while (!replay.engine.replay_finished()) replay.ticks(1);
  EXPECT_FALSE(replay.engine.replay_result().diverged_at.has_value());
  EXPECT_DOUBLE_EQ(replay.read("/scene/wind"), 90 / 127.0);
  EXPECT_EQ(requests, 0) << "a replay learns nothing";
}

TEST(MidiFeedback, AnotherSourceMovesTheFader) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "channel": 2, "address": "/scene/wind"},
                        {"kind": "note", "number": 36, "address": "/scene/mist"})"));
  rig.feedback();
  EXPECT_EQ(rig.feedback(), Bytes{}) << "the values of the start have been sent before";
  rig.send("/scene/wind", 1);
  EXPECT_EQ(rig.feedback(), (Bytes{0xb1, 7, 127}));
  EXPECT_EQ(rig.feedback(), Bytes{});
  rig.send("/scene/mist", true);
  EXPECT_EQ(rig.feedback(), (Bytes{0x90, 36, 127}));
}

TEST(MidiFeedback, FineValues) {
  EXPECT_EQ(feedback_bytes(ControlKind::cc14, 1, 3, 8197), (Bytes{0xb0, 3, 64, 0xb0, 35, 5}));
  EXPECT_EQ(feedback_bytes(ControlKind::pitch_bend, 16, 0, 8197), (Bytes{0xef, 5, 64}));
  EXPECT_EQ(feedback_bytes(ControlKind::nrpn, 1, 130, 8197),
            (Bytes{0xb0, 99, 1, 0xb0, 98, 2, 0xb0, 6, 64, 0xb0, 38, 5}));
  EXPECT_EQ(feedback_bytes(ControlKind::rpn, 1, 1, 1), (Bytes{0xb0, 101, 0, 0xb0, 100, 1, 0xb0, 6, 0, 0xb0, 38, 1}));
  EXPECT_EQ(feedback_bytes(ControlKind::program, 1, 1, 127), Bytes{});
}

TEST(MidiFeedback, AMovingFaderGetsNoEcho) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "takeover": "jump"})"));
  rig.feedback();
  rig.move({0xb0, 7, 30});
  EXPECT_EQ(rig.feedback(), Bytes{});
  rig.move({0xb0, 7, 31});
  rig.send("/scene/wind", 1);
  rig.devices.received(kNano);
  rig.pass(200);
  EXPECT_EQ(rig.devices.received(kNano), Bytes{}) << "it has just moved";
  rig.pass(200);
  EXPECT_EQ(rig.devices.received(kNano), (Bytes{0xb0, 7, 127}));
}

// Many controllers switch the light of a button off when it is released.
TEST(MidiFeedback, TheLightOfAToggleIsSentAgainAfterItsRelease) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 20, "address": "/scene/mist"})"));
  rig.feedback();
  rig.move({0xb0, 20, 127});
  EXPECT_EQ(rig.feedback(), Bytes{});
  rig.move({0xb0, 20, 0});
  EXPECT_EQ(rig.feedback(), (Bytes{0xb0, 20, 127}));
}

TEST(MidiFeedback, IsOffOnRequest) {
  MidiRig rig(map_of(R"({"kind": "cc", "number": 7, "address": "/scene/wind", "feedback": false},
                        {"kind": "cc", "number": 8, "address": "/scene/waves", "mode": "relative"})"));
  rig.send("/scene/wind", 1);
  rig.send("/scene/waves", 8);
  EXPECT_EQ(rig.feedback(), Bytes{});
}

TEST(MidiFeedback, IsLimitedForSlowCables) {
  std::string entries;
  for (int i = 0; i < 100; i++) {
    entries += (i == 0 ? "" : ", ") + fmt::format(R"({{"kind": "cc", "number": {}, "address": "/scene/wind"}})", i);
  }
  MidiRig rig(map_of(entries));
  rig.feedback();
  rig.send("/scene/wind", 1);
  rig.pass(400);
  rig.send("/scene/wind", 0);
  rig.devices.received(kNano);
  rig.pass(100);
  const std::size_t sent = rig.devices.received(kNano).size() / 3;
  EXPECT_GE(sent, 1u);
  EXPECT_LE(sent, 4 * Feedback::kMaxMessages) << "16 each 33 ms";
  rig.pass(1000);
  EXPECT_EQ(sent + rig.devices.received(kNano).size() / 3, 100u) << "all get their turn";
}

}  // namespace
}  // namespace limber::midi::test
