// oscpack's reading side stays in this file, and so do its exceptions.
#include "osc/decode.h"

#include <exception>

#include <fmt/format.h>
#include <oscpack/osc/OscReceivedElements.h>

namespace limber {

namespace {

constexpr std::uint64_t kImmediately = 1;

const char* refused_tag(char tag) {
  switch (tag) {
    case osc::BLOB_TYPE_TAG:
      return "a blob (b)";
    case osc::TIME_TAG_TYPE_TAG:
      return "a time tag (t)";
    case osc::MIDI_MESSAGE_TYPE_TAG:
      return "a MIDI message (m)";
    case osc::RGBA_COLOR_TYPE_TAG:
      return "a packed colour (r)";
    default:
      return nullptr;
  }
}

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
  Message message;
  message.address = received.AddressPattern();
  message.args.reserve(received.ArgumentCount());
  int level = 0;
  for (auto a = received.ArgumentsBegin(); a != received.ArgumentsEnd(); ++a) {
    if (a->IsArrayBegin() || a->IsArrayEnd()) {
      level += a->IsArrayBegin() ? 1 : -1;
      if (level < 2) continue;
      out.refused.push_back({std::move(message.address), "an array inside an array is not taken; send one flat array"});
      return;
    }
    if (const char* what = refused_tag(a->TypeTag())) {
      out.refused.push_back(
          {std::move(message.address), fmt::format("{} is not taken; send numbers (i h f d T F) or text (s)", what)});
      return;
    }
    message.args.push_back(argument_of(*a));
  }
  out.messages.push_back(std::move(message));
}

// the validator has bounded the depth
void add_bundle(const osc::ReceivedBundle& bundle, Decoded& out) {
  for (auto element = bundle.ElementsBegin(); element != bundle.ElementsEnd(); ++element) {
    if (element->IsBundle()) {
      add_bundle(osc::ReceivedBundle(*element), out);
    } else {
      add_message(osc::ReceivedMessage(*element), out);
    }
  }
}

}  // namespace

Result<Decoded> decode_packet(const char* data, std::size_t size) {
  try {
    Decoded decoded;
    const osc::ReceivedPacket packet(data, static_cast<osc::osc_bundle_element_size_t>(size));
    if (packet.IsBundle()) {
      const osc::ReceivedBundle bundle(packet);
      // 0 is no time at all; it is taken as now, like 1
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

}  // namespace limber
