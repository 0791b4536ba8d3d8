// MidiDecoder: the state machine of MIDI 1.0's byte stream.
#include "net/midi/decoder.h"

namespace limber::midi {

namespace {

constexpr std::uint8_t kFirstStatus = 0x80;
constexpr std::uint8_t kFirstSystem = 0xf0;
constexpr std::uint8_t kFirstRealTime = 0xf8;
constexpr std::uint8_t kSongPosition = 0xf2;

// Number of data bytes of a status; 0 if its data is skipped.
std::size_t data_bytes(std::uint8_t status) {
  if (status < kFirstStatus) return 0;
  if (status >= kFirstSystem) return status == kSongPosition ? 2 : 0;
  const int type = status >> 4;
  return type == 0xc || type == 0xd ? 1 : 2;
}

bool send_real_time(std::uint8_t byte, const MidiDecoder::Sink& sink) {
  if (byte < kFirstRealTime) return false;
  switch (byte) {
    case 0xf8:
      sink({MidiKind::clock});
      break;
    case 0xfa:
      sink({MidiKind::start});
      break;
    case 0xfb:
      sink({MidiKind::resume});
      break;
    case 0xfc:
      sink({MidiKind::stop});
      break;
    default:
      break;  // active sensing, reset, undefined
  }
  return true;
}

MidiMessage message_of(std::uint8_t status, const std::array<std::uint8_t, 2>& data) {
  constexpr std::array kKinds = {MidiKind::note_off,       MidiKind::note_on,        MidiKind::key_pressure,
                                 MidiKind::control_change, MidiKind::program_change, MidiKind::channel_pressure,
                                 MidiKind::pitch_bend};
  if (status == kSongPosition) return {MidiKind::song_position, 0, data[0], data[1]};
  MidiMessage message{kKinds[(status >> 4) - 8], static_cast<std::uint8_t>(status & 0xfU), data[0], data[1]};
  if (message.kind == MidiKind::note_on && message.second == 0) message.kind = MidiKind::note_off;
  return message;
}

}  // namespace

void MidiDecoder::decode(std::span<const std::uint8_t> bytes, const Sink& sink) {
  for (const std::uint8_t byte : bytes) {
    if (send_real_time(byte, sink)) continue;
    if (byte >= kFirstStatus) {
      accept_status(byte);
    } else {
      accept_data(byte, sink);
    }
  }
}

// A status ends an incomplete message and system exclusive data.
void MidiDecoder::accept_status(std::uint8_t status) {
  status_ = data_bytes(status) > 0 ? status : 0;
  data_ = {};
  count_ = 0;
}

void MidiDecoder::accept_data(std::uint8_t data, const Sink& sink) {
  if (status_ == 0) return;
  data_[count_++] = data;
  if (count_ < data_bytes(status_)) return;
  sink(message_of(status_, data_));
  count_ = 0;
  data_ = {};
  if (status_ >= kFirstSystem) status_ = 0;  // running status is for messages of channels only
}

}  // namespace limber::midi
