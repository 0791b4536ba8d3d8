// oscpack as the reference of Limber's OSC codec: the functions of net/osc/packets, on top of oscpack alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <oscpack/osc/OscOutboundPacketStream.h>
#include <oscpack/osc/OscReceivedElements.h>

#include "net/osc/packets/decode.h"
#include "net/osc/packets/wire.h"
#include "osc/bad_packets.h"

namespace limber::osc::test::oscpack_reference {

// Its int32 is `long` on all processors except x86, so that it writes and reads wrong packets on 64-bit ones.
static_assert(sizeof(::osc::int32) == 4 && sizeof(::osc::int64) == 8);

inline Arg argument_of(const ::osc::ReceivedMessageArgument& a) {
  switch (a.TypeTag()) {
    case ::osc::INT32_TYPE_TAG:
      return Arg::of(static_cast<double>(a.AsInt32Unchecked()));
    case ::osc::INT64_TYPE_TAG:
      return Arg::of(static_cast<double>(a.AsInt64Unchecked()));
    case ::osc::FLOAT_TYPE_TAG:
      return Arg::of(static_cast<double>(a.AsFloatUnchecked()));
    case ::osc::DOUBLE_TYPE_TAG:
      return Arg::of(a.AsDoubleUnchecked());
    case ::osc::TRUE_TYPE_TAG:
    case ::osc::INFINITUM_TYPE_TAG:
      return Arg::of(true);
    case ::osc::FALSE_TYPE_TAG:
      return Arg::of(false);
    case ::osc::STRING_TYPE_TAG:
      return Arg::of(a.AsStringUnchecked());
    case ::osc::SYMBOL_TYPE_TAG:
      return Arg::of(a.AsSymbolUnchecked());
    case ::osc::CHAR_TYPE_TAG: {
      const char c = a.AsCharUnchecked();
      return Arg::of(std::string_view(&c, 1));
    }
    default:
      return {};
  }
}

inline void add_message(const ::osc::ReceivedMessage& received, Decoded& out) {
  Message message{received.AddressPattern(), {}};
  bool rejected = false;
  int level = 0;
  for (auto a = received.ArgumentsBegin(); a != received.ArgumentsEnd(); ++a) {
    level += a->IsArrayBegin() ? 1 : a->IsArrayEnd() ? -1 : 0;
    rejected |= level > 1 || a->IsBlob() || a->IsTimeTag() || a->IsMidiMessage() || a->IsRgbaColor();
    if (!a->IsArrayBegin() && !a->IsArrayEnd()) message.args.push_back(argument_of(*a));
  }
  if (rejected) {
    out.rejected.push_back({message.address, "unsupported arguments"});
  } else {
    out.messages.push_back(message);
  }
}

inline void add_bundle(const ::osc::ReceivedBundle& bundle, Decoded& out) {
  for (auto element = bundle.ElementsBegin(); element != bundle.ElementsEnd(); ++element) {
    if (element->IsBundle()) {
      add_bundle(::osc::ReceivedBundle(*element), out);
    } else {
      add_message(::osc::ReceivedMessage(*element), out);
    }
  }
}

/// As limber::decode_packet(), with other reasons for rejected messages. The packet must not contain a blob or an
/// element that is larger than the rest: oscpack reads beyond its end, or loops.
inline Result<Decoded> decode_packet(const char* data, std::size_t size) {
  try {
    Decoded decoded;
    const ::osc::ReceivedPacket packet(data, static_cast<::osc::osc_bundle_element_size_t>(size));
    if (packet.IsBundle()) {
      const ::osc::ReceivedBundle bundle(packet);
      decoded.time_tag = std::max<std::uint64_t>(bundle.TimeTag(), 1);  // 0 is undefined, and treated as now
      add_bundle(bundle, decoded);
    } else {
      add_message(::osc::ReceivedMessage(packet), decoded);
    }
    return decoded;
  } catch (const std::exception& e) {
    return Error{e.what()};
  }
}

/// The functions of PacketWriter. Throws if the buffer is too small; oscpack needs more space than it writes.
class Writer {
 public:
  Writer(char* buffer, std::size_t size) : out_(buffer, size) {}

  void begin_bundle(std::uint64_t time_tag) { out_ << ::osc::BeginBundle(time_tag); }
  void end_bundle() { out_ << ::osc::EndBundle; }
  void begin_message(const char* address, std::size_t /*tags*/) { out_ << ::osc::BeginMessage(address); }
  void end_message() { out_ << ::osc::EndMessage; }
  void int32(std::int32_t value) { out_ << ::osc::int32{value}; }
  void int64(std::int64_t value) { out_ << ::osc::int64{value}; }
  void float32(float value) { out_ << value; }
  void float64(double value) { out_ << value; }
  void boolean(bool value) { out_ << value; }
  void nil() { out_ << ::osc::OscNil; }
  void infinitum() { out_ << ::osc::Infinitum; }
  void string(const char* text) { out_ << text; }
  void symbol(const char* text) { out_ << ::osc::Symbol(text); }
  void character(char value) { out_ << value; }
  void color(std::uint32_t rgba) { out_ << ::osc::RgbaColor(rgba); }
  void midi(std::uint32_t message) { out_ << ::osc::MidiMessage(message); }
  void time_tag(std::uint64_t ntp) { out_ << ::osc::TimeTag(ntp); }
  void blob(std::string_view bytes) {
    out_ << ::osc::Blob(bytes.data(), static_cast<::osc::osc_bundle_element_size_t>(bytes.size()));
  }
  void begin_array() { out_ << ::osc::BeginArray; }
  void end_array() { out_ << ::osc::EndArray; }
  std::span<const char> packet() const { return {out_.Data(), out_.Size()}; }

 private:
  ::osc::OutboundPacketStream out_;
};

/// Encodes messages into a buffer that each call overwrites.
class Encoder {
 public:
  /// As limber::encode_message().
  std::span<const char> message(const Message& message) {
    return encode(message, [&](Writer& out) {
      for (const Arg& arg : message.args) {
        if (arg.is_text()) {
          out.string(arg.text.c_str());
        } else if (arg.kind == Arg::Kind::number) {
          out.float32(as_float(arg.number));
        } else {
          out.int32(arg.kind == Arg::Kind::boolean && arg.number != 0 ? 1 : 0);
        }
      }
    });
  }
  /// As limber::encode_tagged(); text for r m t b must consist of hexadecimal digits.
  std::span<const char> tagged(const Message& message, std::string_view tags) {
    return encode(message, [&](Writer& out) {
      auto arg = message.args.begin();
      for (const char tag : tags) {
        if (tag == '[') {
          out.begin_array();
        } else if (tag == ']') {
          out.end_array();
        } else {
          write(tag, *arg++, out);
        }
      }
    });
  }

 private:
  template <class Arguments>
  std::span<const char> encode(const Message& message, const Arguments& write_arguments) {
    Writer out(buffer_.data(), buffer_.size());
    out.begin_message(message.address.c_str(), 0);
    write_arguments(out);
    out.end_message();
    return out.packet().size() > kMaxPacketSize ? std::span<const char>() : out.packet();
  }

  static float as_float(double value) {
    constexpr double kMax = std::numeric_limits<float>::max();
    return static_cast<float>(std::isfinite(value) ? std::clamp(value, -kMax, kMax) : value);
  }

  // The largest double below 2^63 is 2^63 - 1024.
  static std::int64_t as_integer(double value, double min, double max) {
    return std::isfinite(value) ? static_cast<std::int64_t>(std::clamp(std::round(value), min, max)) : 0;
  }

  static std::uint64_t last_digits(const std::string& hex, std::size_t digits) {
    return hex.empty() ? 0 : std::stoull(hex.substr(hex.size() - std::min(hex.size(), digits)), nullptr, 16);
  }

  static void write(char tag, const Arg& arg, Writer& out) {
    switch (tag) {
      case 'i':
        return out.int32(static_cast<std::int32_t>(as_integer(arg.number, -0x1p31, 0x1p31 - 1)));
      case 'h':
        return out.int64(as_integer(arg.number, -0x1p63, 0x1p63 - 1024));
      case 'f':
        return out.float32(as_float(arg.number));
      case 'd':
        return out.float64(arg.number);
      case 'T':
      case 'F':
        return out.boolean(arg.number != 0);
      case 'I':
        return out.infinitum();
      case 's':
        return out.string(arg.text.c_str());
      case 'S':
        return out.symbol(arg.text.c_str());
      case 'c':
        return out.character(arg.text.c_str()[0]);
      case 'r':
        return out.color(static_cast<std::uint32_t>(last_digits(arg.text, 8)));
      case 'm':
        return out.midi(static_cast<std::uint32_t>(last_digits(arg.text, 8)));
      case 't':
        return out.time_tag(last_digits(arg.text, 16));
      case 'b':
        return out.blob(from_hex(arg.text.substr(0, arg.text.size() / 2 * 2)));
      default:
        return out.nil();
    }
  }

  std::array<char, 2 * kMaxPacketSize> buffer_;
};

}  // namespace limber::osc::test::oscpack_reference
