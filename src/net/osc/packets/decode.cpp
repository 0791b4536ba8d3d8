// Decodes packets with a visitor of PacketParser that builds messages and rejects unsupported ones.
#include "net/osc/packets/decode.h"

#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "net/osc/packets/packet_parser.h"

namespace limber::osc {

namespace {

constexpr std::uint64_t kImmediately = 1;

Arg argument_of(char tag, const char* data) {
  switch (tag) {
    case 'i':
      return Arg::of(static_cast<double>(std::bit_cast<std::int32_t>(load_u32(data))));
    case 'h':
      return Arg::of(static_cast<double>(std::bit_cast<std::int64_t>(load_u64(data))));
    case 'f':
      return Arg::of(static_cast<double>(std::bit_cast<float>(load_u32(data))));
    case 'd':
      return Arg::of(std::bit_cast<double>(load_u64(data)));
    case 'T':
    case 'I':
      return Arg::of(true);
    case 'F':
      return Arg::of(false);
    case 's':
    case 'S':
      return Arg::of(data);
    case 'c':
      return Arg::of(std::string_view(data + 3, 1));
    default:
      return {};
  }
}

/// Returns the name of a type that no address accepts, or null.
const char* unsupported_type(char tag) {
  switch (tag) {
    case 'b':
      return "a blob (b)";
    case 't':
      return "a time tag (t)";
    case 'm':
      return "a MIDI message (m)";
    case 'r':
      return "a packed color (r)";
    default:
      return nullptr;
  }
}

class DecodingVisitor {
 public:
  explicit DecodingVisitor(Decoded& out) : out_(out) {}

  void bundle(int depth, std::uint64_t time_tag) {
    // time tag 0 is undefined; it is treated as now, like 1
    const std::uint64_t tag = time_tag == 0 ? kImmediately : time_tag;
    if (depth == 1) out_.time_tag = tag;
    // a nested bundle is not due before the one that contains it
    const auto level = static_cast<std::size_t>(depth);
    time_tags_[level] = depth == 1 ? tag : std::max(tag, time_tags_[level - 1]);
    depth_ = level;
  }
  void end_bundle(int depth) { depth_ = static_cast<std::size_t>(depth - 1); }
  void message(const char* address, const char* tags) {
    message_.address = address;
    message_.args.clear();
    message_.args.reserve(std::strlen(tags));
    array_depth_ = 0;
    rejected_ = false;
  }
  void argument(char tag, const char* data) {
    if (rejected_) return;
    if (tag == '[' || tag == ']') {
      array_depth_ += tag == '[' ? 1 : -1;
      if (array_depth_ > 1) reject("nested arrays are not supported; send one flat array");
    } else if (const char* const type = unsupported_type(tag)) {
      reject(fmt::format("{} is not supported; send numbers (i h f d T F) or text (s)", type));
    } else {
      message_.args.push_back(argument_of(tag, data));
    }
  }
  void end_message() {
    if (rejected_) return;
    out_.messages.push_back(std::move(message_));
    const std::uint64_t tag = time_tags_[depth_];
    if (tag == out_.time_tag) return;
    const std::size_t index = out_.messages.size() - 1;
    const bool continues = !out_.later.empty() && out_.later.back().time_tag == tag &&
                           out_.later.back().first + out_.later.back().count == index;
    if (!continues) out_.later.push_back({index, 0, tag});
    out_.later.back().count++;
  }

 private:
  void reject(std::string reason) {
    out_.rejected.push_back({std::move(message_.address), std::move(reason)});
    rejected_ = true;
  }

  Decoded& out_;
  std::array<std::uint64_t, OscLimits::kDepth + 1> time_tags_{kImmediately};  // by depth
  std::size_t depth_ = 0;
  Message message_;  // of which the arguments are read
  int array_depth_ = 0;
  bool rejected_ = false;
};

}  // namespace

Result<Decoded> decode_packet(const char* data, std::size_t size) {
  Decoded decoded;
  DecodingVisitor visitor(decoded);
  if (const char* const fault = PacketParser<DecodingVisitor>(visitor).packet(data, size)) return Error{fault};
  return decoded;
}

}  // namespace limber::osc
