// Bytes to messages, and messages to movements of controls.
#include "net/midi/decoder.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <string>
#include <vector>

#include "net/midi/controls.h"

namespace limber::midi::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string message_text(const MidiMessage& m) {
  constexpr std::array kNames = {"off",  "on",       "key",   "cc",    "program",  "pressure",
                                 "bend", "position", "clock", "start", "continue", "stop"};
  return fmt::format("{} {} {} {}", kNames[static_cast<std::size_t>(m.kind)], m.channel, m.first, m.second);
}

// The messages, each chunk decoded by a call of its own.
std::vector<std::string> decoded(const std::vector<Bytes>& chunks) {
  MidiDecoder decoder;
  std::vector<std::string> texts;
  for (const Bytes& chunk : chunks)
    decoder.decode(chunk, [&](const MidiMessage& message) { texts.push_back(message_text(message)); });
  return texts;
}

using Texts = std::vector<std::string>;

TEST(MidiDecoder, DecodesEveryKind) {
  EXPECT_EQ(decoded({{0x80, 60, 1}}), Texts{"off 0 60 1"});
  EXPECT_EQ(decoded({{0x91, 60, 100}}), Texts{"on 1 60 100"});
  EXPECT_EQ(decoded({{0xa2, 60, 7}}), Texts{"key 2 60 7"});
  EXPECT_EQ(decoded({{0xbf, 7, 127}}), Texts{"cc 15 7 127"});
  EXPECT_EQ(decoded({{0xc3, 5}}), Texts{"program 3 5 0"});
  EXPECT_EQ(decoded({{0xd4, 9}}), Texts{"pressure 4 9 0"});
  EXPECT_EQ(decoded({{0xe0, 0, 64}}), Texts{"bend 0 0 64"});
  EXPECT_EQ(decoded({{0xf2, 8, 1}}), Texts{"position 0 8 1"});
  EXPECT_EQ(decoded({{0xf8, 0xfa, 0xfb, 0xfc}}), (Texts{"clock 0 0 0", "start 0 0 0", "continue 0 0 0", "stop 0 0 0"}));
}

TEST(MidiDecoder, NoteOnWithoutVelocityIsARelease) { EXPECT_EQ(decoded({{0x90, 60, 0}}), Texts{"off 0 60 0"}); }

TEST(MidiDecoder, RunningStatusContinuesOverChunks) {
  EXPECT_EQ(decoded({{0xb0, 1, 2, 3}, {4, 5}, {6}}), (Texts{"cc 0 1 2", "cc 0 3 4", "cc 0 5 6"}));
}

TEST(MidiDecoder, RealTimeBytesWithinAMessageAreSeparate) {
  EXPECT_EQ(decoded({{0xb0, 0xf8, 1, 0xfe, 2}}), (Texts{"clock 0 0 0", "cc 0 1 2"}));
}

TEST(MidiDecoder, SystemExclusiveIsSkipped) {
  EXPECT_EQ(decoded({{0xf0, 1, 2, 0xf8, 3}, {4, 5, 0xf7, 6, 7, 0xb0, 1, 2}}), (Texts{"clock 0 0 0", "cc 0 1 2"}));
  EXPECT_EQ(decoded({{0xf0, 1, 2, 0xb0, 1, 2}}), Texts{"cc 0 1 2"}) << "without its end";
}

TEST(MidiDecoder, SystemMessagesEndRunningStatus) {
  EXPECT_EQ(decoded({{0xb0, 1, 2, 0xf6, 3, 4}}), Texts{"cc 0 1 2"});
  EXPECT_EQ(decoded({{0xf2, 1, 2, 3, 4}}), Texts{"position 0 1 2"});
  EXPECT_EQ(decoded({{0xf1, 1, 0xf3, 2}}), Texts{});
}

TEST(MidiDecoder, IncompleteMessagesAndLooseDataAreSkipped) {
  EXPECT_EQ(decoded({{1, 2, 3}}), Texts{});
  EXPECT_EQ(decoded({{0xb0, 1, 0xb1, 2, 3}}), Texts{"cc 1 2 3"});
}

std::string event_text(const ControlEvent& e) {
  return fmt::format("{} {} {} {}", control_kind_name(e.kind), e.channel, e.number, e.value);
}

// The movements of one kind.
std::vector<std::string> events(const Bytes& bytes, ControlKind kind) {
  MidiDecoder decoder;
  ControlReader reader;
  std::vector<std::string> texts;
  decoder.decode(bytes, [&](const MidiMessage& message) {
    reader.accept(message, [&](const ControlEvent& event) {
      if (event.kind == kind) texts.push_back(event_text(event));
    });
  });
  return texts;
}

TEST(ControlReader, ReportsSimpleControls) {
  EXPECT_EQ(events({0xb2, 7, 64}, ControlKind::cc), Texts{"cc 3 7 64"});
  EXPECT_EQ(events({0x90, 60, 100, 60, 0}, ControlKind::note), (Texts{"note 1 60 100", "note 1 60 0"}));
  EXPECT_EQ(events({0xe0, 127, 127, 0, 64}, ControlKind::pitch_bend),
            (Texts{"pitch_bend 1 0 16383", "pitch_bend 1 0 8192"}));
  EXPECT_EQ(events({0xd0, 9}, ControlKind::pressure), Texts{"pressure 1 0 9"});
  EXPECT_EQ(events({0xa0, 60, 9}, ControlKind::key_pressure), Texts{"key_pressure 1 60 9"});
  EXPECT_EQ(events({0xc0, 9}, ControlKind::program), Texts{"program 1 9 127"});
}

// The fine half completes a value; from then on the coarse half alone reports nothing, so the value doesn't step back.
TEST(ControlReader, CombinesPairs) {
  EXPECT_EQ(events({0xb0, 1, 10}, ControlKind::cc14), Texts{"cc14 1 1 1280"});
  EXPECT_EQ(events({0xb0, 1, 10, 33, 5, 1, 11, 33, 0, 33, 1}, ControlKind::cc14),
            (Texts{"cc14 1 1 1280", "cc14 1 1 1285", "cc14 1 1 1408", "cc14 1 1 1409"}));
  EXPECT_EQ(events({0xb0, 64, 10}, ControlKind::cc14), Texts{});
}

TEST(ControlReader, ReadsParameters) {
  const Bytes nrpn = {0xb0, 99, 1, 98, 2, 6, 64, 38, 3, 99, 1, 98, 2, 6, 64, 38, 4};
  EXPECT_EQ(events(nrpn, ControlKind::nrpn), (Texts{"nrpn 1 130 8192", "nrpn 1 130 8195", "nrpn 1 130 8196"}));
  EXPECT_EQ(events({0xb0, 101, 0, 100, 1, 6, 127, 38, 127}, ControlKind::rpn),
            (Texts{"rpn 1 1 16256", "rpn 1 1 16383"}));
  EXPECT_EQ(events({0xb0, 99, 1, 98, 2, 6, 1, 96, 0, 96, 0, 97, 0}, ControlKind::nrpn),
            (Texts{"nrpn 1 130 128", "nrpn 1 130 129", "nrpn 1 130 130", "nrpn 1 130 129"}));
}

TEST(ControlReader, DataWithoutAParameterIsNone) {
  EXPECT_EQ(events({0xb0, 6, 64}, ControlKind::nrpn), Texts{});
  EXPECT_EQ(events({0xb0, 99, 1, 6, 64}, ControlKind::nrpn), Texts{}) << "half of a number";
  EXPECT_EQ(events({0xb0, 99, 1, 98, 2, 101, 127, 100, 127, 6, 64}, ControlKind::nrpn), Texts{}) << "deselected";
}

}  // namespace
}  // namespace limber::midi::test
