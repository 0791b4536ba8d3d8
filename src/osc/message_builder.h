// MessageBuilder: which arguments a message may hold, and how they become a Message. Both codecs build with it.
#pragma once

#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "osc/decode.h"

namespace limber {

/// Builds one message of `out`. When a function returns false, the message is rejected and complete. [any]
class MessageBuilder {
 public:
  MessageBuilder(Decoded& out, std::string_view address, std::size_t arguments) : out_(out) {
    message_.address = address;
    message_.args.reserve(arguments);
  }

  /// '[' or ']'; the elements of an array are arguments of the message like others.
  bool bracket(char tag) {
    level_ += tag == '[' ? 1 : -1;
    return level_ < 2 || reject("an array inside an array is not taken; send one flat array");
  }
  /// Rejects what no address takes: b, t, m, r.
  bool accept(char tag) {
    const char* const type = rejected_type(tag);
    return type == nullptr || reject(fmt::format("{} is not taken; send numbers (i h f d T F) or text (s)", type));
  }
  void add(Arg arg) { message_.args.push_back(std::move(arg)); }
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
        return "a packed colour (r)";
      default:
        return nullptr;
    }
  }
  bool reject(std::string text) {
    out_.refused.push_back({std::move(message_.address), std::move(text)});
    return false;
  }

  Decoded& out_;
  Message message_;
  int level_ = 0;
};

}  // namespace limber
