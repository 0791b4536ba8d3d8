// OscpackWriter: the interface of PacketWriter on top of oscpack.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <oscpack/osc/OscOutboundPacketStream.h>

namespace limber {

/// oscpack throws in the middle of a message if the buffer is too small, so callers check sizes first. Strings are
/// NUL-terminated. [any]
class OscpackWriter {
 public:
  OscpackWriter(char* buffer, std::size_t size) : out_(buffer, size) {}

  void begin_bundle(std::uint64_t time_tag) { out_ << osc::BeginBundle(time_tag); }
  void end_bundle() { out_ << osc::EndBundle; }
  void begin_message(const char* address, std::size_t /*tags*/) { out_ << osc::BeginMessage(address); }
  void end_message() { out_ << osc::EndMessage; }
  void int32(std::int32_t value) { out_ << osc::int32{value}; }
  void int64(std::int64_t value) { out_ << osc::int64{value}; }
  void float32(float value) { out_ << value; }
  void float64(double value) { out_ << value; }
  void boolean(bool value) { out_ << value; }
  void nil() { out_ << osc::OscNil; }
  void infinitum() { out_ << osc::Infinitum; }
  void string(const char* text) { out_ << text; }
  void symbol(const char* text) { out_ << osc::Symbol(text); }
  void character(char value) { out_ << value; }
  void color(std::uint32_t rgba) { out_ << osc::RgbaColor(rgba); }
  void midi(std::uint32_t message) { out_ << osc::MidiMessage(message); }
  void time_tag(std::uint64_t ntp) { out_ << osc::TimeTag(ntp); }
  void blob(std::string_view bytes) {
    out_ << osc::Blob(bytes.data(), static_cast<osc::osc_bundle_element_size_t>(bytes.size()));
  }
  void begin_array() { out_ << osc::BeginArray; }
  void end_array() { out_ << osc::EndArray; }
  std::span<const char> packet() const { return {out_.Data(), out_.Size()}; }

 private:
  osc::OutboundPacketStream out_;
};

}  // namespace limber
