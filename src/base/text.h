// Text that comes from outside: the one naming rule, OSC patterns, near names, printable form, numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limber {

/// The one naming rule: names of rows, types and parameters are compared without case and underscores.
/// Gives the form that is compared: "angularServo_Position" -> "angularservoposition".
std::string plain_name(std::string_view name);
bool same_name(std::string_view a, std::string_view b);

/// OSC's pattern rules for one name: `?` `*` `[a-z]` `[!a]` `{ab,cd}`. Bounded: a pattern that needs more than
/// 20 000 steps, or 200 stars and braces at a time, matches nothing. A malformed pattern matches only itself.
/// The steps taken are added to `steps`.
bool pattern_match(std::string_view pattern, std::string_view name, int* steps = nullptr);
/// Whether a name holds any of OSC's pattern characters.
bool is_pattern(std::string_view name);

/// The nearest of `names` to what was written (edit distance at most a third of its length, neighbours
/// that changed places being one edit, ignoring case), or empty.
std::string_view nearest_name(std::string_view written, std::span<const std::string_view> names);
/// "; did you mean 'x'?" or, without a near one, "; there are: a, b, c …" (at most eight), or "; none exist".
std::string name_hint(std::string_view written, std::span<const std::string_view> names);
std::string name_hint(std::string_view written, const std::vector<std::string>& names);

/// Control characters and broken UTF-8 as \xNN, so that nothing from outside writes to a terminal as it likes.
std::string printable(std::string_view text);

/// The text, or where it is longer than `most` bytes (at least 16) its beginning and its end with " … " between.
std::string shortened(std::string_view text, std::size_t most);

/// A finite number that fills the whole text (blanks around it aside), whatever the locale; else nothing.
std::optional<double> parse_number(std::string_view text);
/// The shortest text that reads back as the same number: "0.1", "-9.81", "1e+20".
std::string number_text(double value);

/// Characters that OSC forbids in addresses (and '%') as %20 style, and back.
std::string escape_name(std::string_view name);
std::string unescape_name(std::string_view part);

/// A name for a thing: 1 to 128 bytes of printable UTF-8. The text of what is wrong, or nothing.
std::optional<std::string> name_fault(std::string_view name);

/// The text cut at `separator`; empty pieces are kept.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace limber
