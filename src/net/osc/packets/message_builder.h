// MessageBuilder: converts decoded OSC arguments to a Message and rejects unsupported ones. Both codecs use it.
#pragma once

#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "net/osc/packets/decode.h"

namespace limber {

/// Builds one message of `out`. After a function has returned false, the message is rejected and must not be extended.
/// [any]
class MessageBuilder {
 public:
  MessageBuilder(Decoded& out, std::string_view address, std::size_t arguments) : out_(out) {
    message_.address = address;
    message_.args.reserve(arguments);
  }

  /// Handles '[' and ']'; array elements become ordinary arguments of the message. Returns false for nested arrays.
  bool bracket(char tag) {
    level_ += tag == '[' ? 1 : -1;
    return level_ < 2 || reject("nested arrays are not supported; send one flat array");
  }
  /// Returns false for the types that no address accepts: b, t, m, r.
  bool accept(char tag) {
    const char* const type = rejected_type(tag);
    return type == nullptr || reject(fmt::format("{} is not supported; send numbers (i h f d T F) or text (s)", type));
  }
  void add(Arg arg) { message_.args.push_back(std::move(arg)); }
  /// Appends the message to the decoded ones.
  void finish() { out_.messages.push_back(std::move(message_)); }

 private:
  static const char* rejected_type(char tag) {
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
  bool reject(std::string text) {
    out_.rejected.push_back({std::move(message_.address), std::move(text)});
    return false;
  }

  Decoded& out_;
  Message message_;
  int level_ = 0;
};

}  // namespace limber
