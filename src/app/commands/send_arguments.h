// Converts the words of `limber send` to the arguments of an OSC message.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/result.h"

namespace limber::app {

/// Converts a word to an argument: a number, true or false, else text. A word in its own quotes ("'1'") is always text.
Arg parse_arg(const std::string& word);

/// Returns a message for encode_tagged(). `tags`: i h f d take a number, s S text, c a character, r m eight hexadecimal
/// digits, t sixteen, b pairs of them; T F N I and brackets take no word. The error names the word that doesn't match.
/// [any]
Result<Message> tagged_message(const std::string& address, std::string_view tags,
                               const std::vector<std::string>& words);

}  // namespace limber::app
