// Numbers and excerpts of XML attributes, as the importers read and report them.
#pragma once

#include <string>
#include <string_view>

namespace limber::model {

inline constexpr std::string_view kBlanks = " \t\r\n";

/// The text without blanks at its ends. [any]
std::string_view trimmed(std::string_view text);
/// The text for a message: printable, at most 60 bytes. [any]
std::string printable_excerpt(std::string_view text);

/// A parsed number, or the reason why the text is not a number, and its fix. `reason` is empty on success.
struct NumberText {
  double value = 0;
  const char* reason = "";
  const char* fix = "";
};

/// Parses one finite number that is the whole text; an underflow is 0. [any]
NumberText read_number(std::string_view text);

}  // namespace limber::model
