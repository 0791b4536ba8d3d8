// Converts the arguments of `limber send --tags` to the OSC types given by the tags.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/result.h"

namespace limber {

/// Returns a message for encode_tagged(). `tags`: i h f d take a number, s S text, c a character, r m eight hexadecimal
/// digits, t sixteen, b pairs of them; T F N I and brackets take no word. The error names the word that doesn't match.
/// [any]
Result<Message> tagged_message(const std::string& address, std::string_view tags,
                               const std::vector<std::string>& words);

}  // namespace limber
