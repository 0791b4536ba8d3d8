// MidiDecoder: splits a stream of MIDI bytes into messages. [one thread]
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace limber::midi {

enum class MidiKind : std::uint8_t {
  note_off,  ///< Also a note-on with velocity 0.
  note_on,
  key_pressure,
  control_change,
  program_change,
  channel_pressure,
  pitch_bend,
  song_position,
  clock,
  start,
  resume,  ///< MIDI calls it Continue.
  stop,
};

struct MidiMessage {
  MidiKind kind = MidiKind::clock;
  std::uint8_t channel = 0;  ///< 0 .. 15; 0 for messages without a channel.
  std::uint8_t first = 0;    ///< First data byte, 0 .. 127: the number of a note or control.
  std::uint8_t second = 0;   ///< Second data byte, 0 .. 127.

  /// Both data bytes as one number, 0 .. 16383: of pitch bend and song position.
  int fourteen_bits() const { return second * 128 + first; }
};

/// Accepts any bytes: understands running status and real-time bytes within other messages, and skips system exclusive
/// data, incomplete messages and data without a status.
class MidiDecoder {
 public:
  using Sink = std::function<void(const MidiMessage&)>;
  /// Calls `sink` for each message that the bytes complete.
  void decode(std::span<const std::uint8_t> bytes, const Sink& sink);

 private:
  void accept_status(std::uint8_t status);
  void accept_data(std::uint8_t data, const Sink& sink);

  std::uint8_t status_ = 0;  // of the message that the next data byte belongs to; 0: data is skipped
  std::array<std::uint8_t, 2> data_{};
  std::size_t count_ = 0;  // number of bytes in data_
};

}  // namespace limber::midi
