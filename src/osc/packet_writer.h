// PacketWriter: writes OSC 1.0 packets with every argument type, and nested bundles, into a buffer of the caller.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "osc/validate.h"

namespace limber {

/// A message begins with the number of its type tags, so that each argument is written to its final place. What does
/// not fit the buffer, or calls in the wrong order (an argument beyond the number of tags, a bundle that ends while a
/// message is open), make the packet invalid: it is empty then. [any]
class PacketWriter {
 public:
  PacketWriter(char* buffer, std::size_t size) : begin_(buffer), size_(size) {}

  /// Bundles may contain others down to OscLimits::kDepth.
  void begin_bundle(std::uint64_t time_tag);
  void end_bundle();

  /// `tags`: number of type tags of its arguments, brackets of arrays included.
  void begin_message(std::string_view address, std::size_t tags);
  void end_message();

  void int32(std::int32_t value) { four('i', static_cast<std::uint32_t>(value)); }
  void int64(std::int64_t value) { eight('h', static_cast<std::uint64_t>(value)); }
  void float32(float value);
  void float64(double value);
  void boolean(bool value) { argument(value ? 'T' : 'F', 0); }
  void nil() { argument('N', 0); }
  void infinitum() { argument('I', 0); }
  void string(std::string_view text) { padded_text('s', text); }  ///< Without NULs.
  void symbol(std::string_view text) { padded_text('S', text); }
  void character(char value) { four('c', static_cast<unsigned char>(value)); }
  void color(std::uint32_t rgba) { four('r', rgba); }
  void midi(std::uint32_t message) { four('m', message); }  ///< From the highest byte: port, status, data, data.
  void time_tag(std::uint64_t ntp) { eight('t', ntp); }
  void blob(std::string_view bytes);
  void begin_array() { argument('[', 0); }
  void end_array() { argument(']', 0); }

  /// The finished packet; empty while something is open, and if it is invalid.
  std::span<const char> packet() const;

 private:
  /// The place of `bytes` more bytes; null: they don't fit.
  char* extend(std::size_t bytes);
  /// The place of a tag's value; null: the packet is invalid.
  char* argument(char tag, std::size_t bytes);
  void four(char tag, std::uint32_t value);
  void eight(char tag, std::uint64_t value);
  void padded_text(char tag, std::string_view text);
  /// In a bundle an element begins with its size.
  bool begin_element();
  void end_element();

  char* begin_;
  std::size_t size_;
  std::size_t used_ = 0;
  std::size_t tag_ = 0;                                        // where the next type tag belongs
  std::size_t tags_left_ = 0;                                  // of the open message
  std::array<std::size_t, OscLimits::kDepth + 1> elements_{};  // where the open elements begin
  std::size_t open_ = 0;
  bool message_open_ = false;
  bool valid_ = true;
};

}  // namespace limber
