// Fuzzes MIDI bytes: any division into pieces gives the same messages, all values are within their ranges, and the
// clock and the controls of a map accept them. A text that begins with { is a map.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/target.h"
#include "net/midi/clock/clock_in.h"
#include "net/midi/controls.h"
#include "net/midi/learner.h"
#include "net/midi/map.h"
#include "sim/clock/clock_reading.h"

namespace {

using limber::must;
using limber::midi::MidiMessage;

std::vector<MidiMessage> decode(std::span<const std::uint8_t> bytes, std::size_t piece) {
  limber::midi::MidiDecoder decoder;
  std::vector<MidiMessage> messages;
  while (!bytes.empty()) {
    const std::size_t size = std::min(piece, bytes.size());
    decoder.decode(bytes.first(size), [&](const MidiMessage& message) { messages.push_back(message); });
    bytes = bytes.subspan(size);
  }
  return messages;
}

bool same(const MidiMessage& a, const MidiMessage& b) {
  return a.kind == b.kind && a.channel == b.channel && a.first == b.first && a.second == b.second;
}

void read_controls(const std::vector<MidiMessage>& messages) {
  limber::midi::ControlReader reader;
  limber::midi::Learner learner;
  learner.begin({"/a", 0, {}});
  std::int64_t time = 0;
  for (const MidiMessage& message : messages) {
    must(message.channel < 16 && message.first < 128 && message.second < 128);
    reader.accept(message, [&](const limber::midi::ControlEvent& event) {
      must(event.channel >= 1 && event.channel <= 16);
      must(event.number >= 0 && (event.number == 0 || event.number <= max_number(event.kind)));
      must(event.value >= 0 && event.value <= max_value(event.kind));
      learner.accept("port", event, time);
    });
    time += 1'000'000;
    if (const auto entry = learner.finish(time))
      must(limber::midi::parse_midi_map(limber::midi::midi_map_text({*entry})).ok());
  }
}

// The time of a pulse depends on the note before it.
void follow_clock(const std::vector<MidiMessage>& messages) {
  limber::midi::ClockIn clock;
  double time = 0;
  for (const MidiMessage& message : messages) {
    time += message.first * 1e-3;
    clock.accept(message, time += 0.01);
    for (const limber::Message& sent : clock.drain(time)) {
      if (sent.address != "/clock/sync") continue;
      must(sent.args.size() == 3 && std::isfinite(sent.args[0].number) && sent.args[0].number >= 0);
      must(sent.args[1].number >= limber::sim::kMinTempo && sent.args[1].number <= limber::sim::kMaxTempo);
      must(sent.args[2].number == time);
    }
  }
}

void read_map(std::string_view text) {
  const auto map = limber::midi::parse_midi_map(text);
  if (!map) return must(!map.error().empty());
  const std::string written = midi_map_text(*map);
  const auto again = limber::midi::parse_midi_map(written);
  must(again.ok() && midi_map_text(*again) == written);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0 && data[0] == '{') {
    read_map({reinterpret_cast<const char*>(data), size});
    return 0;
  }
  const std::vector<MidiMessage> messages = decode({data, size}, size);
  for (const std::size_t piece : {1, 2, 3, 7}) {
    const std::vector<MidiMessage> others = decode({data, size}, piece);
    must(others.size() == messages.size());
    for (std::size_t i = 0; i < messages.size(); i++) must(same(messages[i], others[i]));
  }
  read_controls(messages);
  follow_clock(messages);
  return 0;
}
