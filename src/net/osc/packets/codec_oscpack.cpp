// The oscpack codec. Its exceptions do not leave this file.
#include <exception>

#include <oscpack/osc/OscReceivedElements.h>

#include "net/osc/packets/codec.h"
#include "net/osc/packets/message_builder.h"
#include "net/osc/packets/message_encoder.h"
#include "net/osc/packets/oscpack_writer.h"

namespace limber::oscpack_codec {

namespace {

constexpr std::uint64_t kImmediately = 1;

Arg argument_of(const osc::ReceivedMessageArgument& a) {
  switch (a.TypeTag()) {
    case osc::INT32_TYPE_TAG:
      return Arg::of(static_cast<double>(a.AsInt32Unchecked()));
    case osc::INT64_TYPE_TAG:
      return Arg::of(static_cast<double>(a.AsInt64Unchecked()));
    case osc::FLOAT_TYPE_TAG:
      return Arg::of(static_cast<double>(a.AsFloatUnchecked()));
    case osc::DOUBLE_TYPE_TAG:
      return Arg::of(a.AsDoubleUnchecked());
    case osc::TRUE_TYPE_TAG:
    case osc::INFINITUM_TYPE_TAG:
      return Arg::of(true);
    case osc::FALSE_TYPE_TAG:
      return Arg::of(false);
    case osc::STRING_TYPE_TAG:
      return Arg::of(a.AsStringUnchecked());
    case osc::SYMBOL_TYPE_TAG:
      return Arg::of(a.AsSymbolUnchecked());
    case osc::CHAR_TYPE_TAG: {
      const char c = a.AsCharUnchecked();
      return Arg::of(std::string_view(&c, 1));
    }
    default:
      return {};
  }
}

void add_message(const osc::ReceivedMessage& received, Decoded& out) {
  MessageBuilder message(out, received.AddressPattern(), received.ArgumentCount());
  for (auto a = received.ArgumentsBegin(); a != received.ArgumentsEnd(); ++a) {
    if (a->IsArrayBegin() || a->IsArrayEnd()) {
      if (!message.bracket(a->TypeTag())) return;
      continue;
    }
    if (!message.accept(a->TypeTag())) return;
    message.add(argument_of(*a));
  }
  message.finish();
}

// Recursion is safe because the validator limits the depth.
void add_bundle(const osc::ReceivedBundle& bundle, Decoded& out) {
  for (auto element = bundle.ElementsBegin(); element != bundle.ElementsEnd(); ++element) {
    if (element->IsBundle()) {
      add_bundle(osc::ReceivedBundle(*element), out);
    } else {
      add_message(osc::ReceivedMessage(*element), out);
    }
  }
}

// The sizes were checked, so no call is expected to throw.
template <class Encode>
std::span<const char> without_exceptions(const Encode& encode) {
  try {
    return encode();
  } catch (const std::exception&) {
    const bool oscpack_found_the_buffer_too_small = true;
    LIMBER_CHECK(!oscpack_found_the_buffer_too_small);
    return {};
  }
}

using Encoder = MessageEncoder<OscpackWriter>;

}  // namespace

Result<Decoded> decode(const char* data, std::size_t size) {
  try {
    Decoded decoded;
    const osc::ReceivedPacket packet(data, static_cast<osc::osc_bundle_element_size_t>(size));
    if (packet.IsBundle()) {
      const osc::ReceivedBundle bundle(packet);
      // time tag 0 is undefined; it is treated as now, like 1
      decoded.time_tag = bundle.TimeTag() == 0 ? kImmediately : bundle.TimeTag();
      add_bundle(bundle, decoded);
    } else {
      add_message(osc::ReceivedMessage(packet), decoded);
    }
    return decoded;
  } catch (const std::exception& e) {
    return Error{e.what()};
  }
}

std::span<const char> encode(const Message& message, PacketBuffer& buffer) {
  return without_exceptions([&] { return Encoder::message(message, buffer); });
}

std::span<const char> encode_tagged(const Message& message, std::string_view tags, PacketBuffer& buffer) {
  return without_exceptions([&] { return Encoder::tagged(message, tags, buffer); });
}

std::span<const char> encode_pong(std::uint64_t tick, double time, PacketBuffer& buffer) {
  return without_exceptions([&] { return Encoder::pong(tick, time, buffer); });
}

}  // namespace limber::oscpack_codec
