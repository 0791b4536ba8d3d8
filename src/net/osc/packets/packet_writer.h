// PacketWriter: writes OSC 1.0 packets with all argument types and nested bundles into the caller's buffer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "net/osc/packets/validate.h"

namespace limber::osc {

/// The caller gives a message's number of type tags first, so that each argument is written to its final position. A
/// packet becomes invalid, and is then empty, if it does not fit the buffer or if calls come in the wrong order (more
/// arguments than tags, a bundle that ends while a message is open). [any]
class PacketWriter {
 public:
  PacketWriter(char* buffer, std::size_t size) : begin_(buffer), size_(size) {}

  /// Bundles may be nested up to OscLimits::kDepth.
  void begin_bundle(std::uint64_t time_tag);
  void end_bundle();

  /// `tags`: number of type tags, including array brackets.
  void begin_message(std::string_view address, std::size_t tags);
  void end_message();

  void int32(std::int32_t value) { write_u32('i', static_cast<std::uint32_t>(value)); }
  void int64(std::int64_t value) { write_u64('h', static_cast<std::uint64_t>(value)); }
  void float32(float value);
  void float64(double value);
  void boolean(bool value) { argument(value ? 'T' : 'F', 0); }
  void nil() { argument('N', 0); }
  void infinitum() { argument('I', 0); }
  void string(std::string_view text) { padded_text('s', text); }  ///< Must not contain NULs.
  void symbol(std::string_view text) { padded_text('S', text); }
  void character(char value) { write_u32('c', static_cast<unsigned char>(value)); }
  void color(std::uint32_t rgba) { write_u32('r', rgba); }
  /// `message`, from the highest byte: port, status, data 1, data 2.
  void midi(std::uint32_t message) { write_u32('m', message); }
  void time_tag(std::uint64_t ntp) { write_u64('t', ntp); }
  void blob(std::string_view bytes);
  void begin_array() { argument('[', 0); }
  void end_array() { argument(']', 0); }

  /// The finished packet; empty while an element is open or if the packet is invalid.
  std::span<const char> packet() const;

 private:
  /// Appends `bytes` bytes and returns their position, or null if they don't fit.
  char* extend(std::size_t bytes);
  /// Appends an argument and returns the position of its value, or null if the packet is invalid.
  char* argument(char tag, std::size_t bytes);
  void write_u32(char tag, std::uint32_t value);
  void write_u64(char tag, std::uint64_t value);
  void padded_text(char tag, std::string_view text);
  /// Begins a bundle or message; inside a bundle it is preceded by its size.
  bool begin_element();
  void end_element();

  char* begin_;
  std::size_t size_;
  std::size_t used_ = 0;
  std::size_t tag_ = 0;                                        // position of the next type tag
  std::size_t tags_left_ = 0;                                  // of the open message
  std::array<std::size_t, OscLimits::kDepth + 1> elements_{};  // start offsets of the open elements
  std::size_t open_ = 0;
  bool message_open_ = false;
  bool valid_ = true;
};

}  // namespace limber::osc
