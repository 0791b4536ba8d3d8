// The text of the MIDI map.
#include "net/midi/map.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace limber::midi::test {
namespace {

std::string with_entry(const std::string& entry) {
  return "{\"limber midi\": 1, \"entries\": [\n  {\"kind\": \"cc\", \"number\": 1, \"address\": \"/a\"},\n  " + entry +
         "\n]}";
}

std::string error_of(const std::string& entry) {
  const Result<MidiMap> map = parse_midi_map(with_entry(entry));
  return map ? "" : map.error();
}

TEST(MidiMap, ReadsEveryField) {
  const Result<MidiMap> map = parse_midi_map(with_entry(
      R"({"port": "nano", "channel": 2, "kind": "cc14", "number": 7, "address": "/scene/wind", "component": 2,
          "range": [2, -1.5], "mode": "absolute", "takeover": "jump", "feedback": false, "note": "left fader"})"));
  ASSERT_TRUE(map.ok()) << map.error();
  ASSERT_EQ(map->size(), 2u);
  const MidiEntry& entry = (*map)[1];
  EXPECT_EQ(entry.port, "nano");
  EXPECT_EQ(entry.channel, 2);
  EXPECT_EQ(entry.kind, ControlKind::cc14);
  EXPECT_EQ(entry.number, 7);
  EXPECT_EQ(entry.address, "/scene/wind");
  EXPECT_EQ(entry.component, 2);
  EXPECT_EQ(entry.range, (std::array{2.0, -1.5}));
  EXPECT_EQ(entry.mode, ControlMode::absolute);
  EXPECT_FALSE(entry.pickup);
  EXPECT_EQ(entry.feedback, false);
  EXPECT_TRUE((*map)[0].pickup);
  EXPECT_EQ((*map)[0].feedback, std::nullopt);
}

TEST(MidiMap, WrittenTextIsReadAgain) {
  const std::string text = with_entry(
      R"({"port": "nano", "channel": 16, "kind": "note", "number": 36, "address": "/preset/recall", "mode": "trigger",
          "values": ["calm", 2.5, true], "note": "pad"})");
  const Result<MidiMap> map = parse_midi_map(text);
  ASSERT_TRUE(map.ok()) << map.error();
  const std::string written = midi_map_text(*map);
  const Result<MidiMap> again = parse_midi_map(written);
  ASSERT_TRUE(again.ok()) << again.error();
  EXPECT_EQ(midi_map_text(*again), written);
  EXPECT_EQ((*again)[1].values.size(), 3u);
  EXPECT_EQ((*again)[1].values[2].kind, Arg::Kind::boolean);
  EXPECT_NE(written.find(R"(    {"port":"nano","channel":16,"kind":"note","number":36,)"), std::string::npos)
      << written;
}

TEST(MidiMap, AnEmptyFileHasNoEntries) {
  EXPECT_TRUE(parse_midi_map(" \n").value().empty());
  EXPECT_TRUE(parse_midi_map(midi_map_text({})).value().empty());
}

TEST(MidiMap, ErrorsNameLineEntryAndField) {
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 128, "address": "/a"})"),
            "line 3, entry 2: number: must be a whole number from 0 to 127");
  EXPECT_EQ(error_of(R"({"kind": "cc", "address": "/a"})"),
            "line 3, entry 2: number: must be given, a whole number from 0 to 127");
  EXPECT_EQ(error_of(R"({"kind": "pitch_bend", "number": 1, "address": "/a"})"),
            "line 3, entry 2: number: pitch_bend has no number; leave it out");
  EXPECT_EQ(error_of(R"({"kind": "knob", "number": 1, "address": "/a"})"),
            "line 3, entry 2: kind: unknown kind 'knob'; expected one of: cc, cc14, nrpn, rpn, note, key_pressure, "
            "pressure, pitch_bend, program");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "adress": "/a"})"),
            "line 3, entry 2: there is no field 'adress'; did you mean 'address'?");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "a"})"),
            "line 3, entry 2: address: 'a' is not an address; it must begin with /");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/midi/learn"})"),
            "line 3, entry 2: address: a control can't learn or forget other controls; name another address");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/a", "range": [1, 1]})"),
            "line 3, entry 2: range: must be a list of two different numbers, such as [0, 1]");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/a", "mode": "relativ"})"),
            "line 3, entry 2: mode: unknown mode 'relativ'; expected one of: absolute, relative, relative_offset, "
            "relative_sign, toggle, momentary, trigger");
  EXPECT_EQ(error_of(R"({"kind": "nrpn", "number": 1, "address": "/a", "mode": "relative"})"),
            "line 3, entry 2: mode: nrpn has no relative values; use cc");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/a", "takeover": "soft"})"),
            "line 3, entry 2: takeover: unknown takeover 'soft'; expected one of: pickup, jump");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/a", "feedback": 1})"),
            "line 3, entry 2: feedback: must be true or false");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/a", "channel": 0})"),
            "line 3, entry 2: channel: must be a whole number from 1 to 16");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/a", "step": 0})"),
            "line 3, entry 2: step: must be a number other than 0");
  EXPECT_EQ(error_of(R"({"kind": "cc", "number": 1, "address": "/a", "values": [1]})"),
            "line 3, entry 2: values: are of the mode trigger only; set \"mode\": \"trigger\"");
  EXPECT_EQ(error_of("7"),
            "entry 2: must be an object, such as {\"kind\": \"cc\", \"number\": 7, \"address\": "
            "\"/scene/wind\"}");
}

TEST(MidiMap, BracketsInTextsDoNotCountAsLines) {
  EXPECT_EQ(
      error_of("{\"kind\": \"cc\", \"number\": 1, \"address\": \"/a\", \"note\": \"{[\\\"{\"},\n{}").substr(0, 15),
      "line 4, entry 3");
}

TEST(MidiMap, ErrorsNameTheLineOfJson) {
  EXPECT_EQ(parse_midi_map("{\n\"limber midi\": 1,\n\"entries\": [}").error(),
            "line 3: not valid JSON; a comma, a quote or a bracket is missing or too much");
  EXPECT_EQ(parse_midi_map("{}").error(), "not a MIDI map; expected {\"limber midi\": 1, \"entries\": [ … ]}");
  EXPECT_EQ(parse_midi_map(R"({"limber midi": 2, "entries": []})").error(),
            "it was written by a newer version of Limber; \"limber midi\" must be 1");
}

TEST(MidiMap, TheExampleOfTheDocumentationIsValid) {
  std::ifstream page(LIMBER_SOURCE_DIR "/docs/howto/midi.md");
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  const std::size_t begin = text.find("```json\n") + 8;
  const Result<MidiMap> map = parse_midi_map(std::string_view(text).substr(begin, text.find("```", begin) - begin));
  ASSERT_TRUE(map.ok()) << map.error();
  EXPECT_EQ(map->size(), 8u);
}

TEST(MidiMap, PortsMatchByAPartOfTheirName) {
  EXPECT_TRUE(port_matches("nanoKONTROL2:nanoKONTROL2 MIDI 1", "NANOkontrol"));
  EXPECT_TRUE(port_matches("x", ""));
  EXPECT_FALSE(port_matches("nano", "nanoKONTROL"));
  MidiEntry entry;
  entry.port = "nano";
  entry.channel = 2;
  entry.number = 7;
  EXPECT_TRUE(matches(entry, "my nano", {ControlKind::cc, 2, 7, 0}));
  EXPECT_FALSE(matches(entry, "my nano", {ControlKind::cc, 1, 7, 0}));
  EXPECT_FALSE(matches(entry, "other", {ControlKind::cc, 2, 7, 0}));
  EXPECT_FALSE(matches(entry, "my nano", {ControlKind::note, 2, 7, 0}));
  entry.channel = 0;
  EXPECT_TRUE(matches(entry, "my nano", {ControlKind::cc, 9, 7, 0}));
}

}  // namespace
}  // namespace limber::midi::test
