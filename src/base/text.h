// Functions for text from external sources: name comparison, OSC patterns, suggestions for misspelled names, escaping,
// numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limber {

/// Names of properties, types and parameters are compared without case and underscores. Returns the normalized form:
/// "angularServo_Position" -> "angularservoposition".
std::string normalized_name(std::string_view name);
/// True if both names have the same normalized form. Does not allocate.
bool same_name(std::string_view a, std::string_view b);
/// Like same_name() for OSC addresses; also ignores a trailing slash of `received`.
bool same_address(std::string_view received, std::string_view address);

/// True if both texts are equal but for the case of ASCII letters.
bool same_in_any_case(std::string_view a, std::string_view b);

/// Splits an error message into its text and its last sentence, which says how to fix it; with `default_fix` if there
/// is only one sentence.
std::pair<std::string, std::string> split_fix(const std::string& error, std::string_view default_fix);

/// Matches one name against an OSC pattern: `?` `*` `[a-z]` `[!a]` `{ab,cd}`. The work is bounded: a pattern that needs
/// more than 20 000 steps, or 200 nested stars and braces, matches nothing. A malformed pattern matches only itself.
/// Adds the number of steps to `steps`.
bool pattern_match(std::string_view pattern, std::string_view name, int* steps = nullptr);
/// True if the name contains an OSC pattern character.
bool is_pattern(std::string_view name);

/// Returns the name with the smallest edit distance to `written`, if it is at most a third of the length of `written`;
/// else empty. Ignores case; swapped neighbors count as one edit.
std::string_view nearest_name(std::string_view written, std::span<const std::string_view> names);
/// Returns the end of a *not found* message: "; did you mean 'x'?", or without a similar name "; there are: a, b, c …"
/// (at most eight), or "; none exist".
std::string name_hint(std::string_view written, std::span<const std::string_view> names);
std::string name_hint(std::string_view written, const std::vector<std::string>& names);

/// Escapes control characters and invalid UTF-8 as \xNN, so that external text can't control the terminal.
std::string printable(std::string_view text);

/// Shortens the text to `max_bytes` bytes (at least 16) if it is longer: its beginning and its end with " … " between.
std::string shortened(std::string_view text, std::size_t max_bytes);

/// Parses a finite number that is the whole text except for surrounding blanks, independent of the locale.
std::optional<double> parse_number(std::string_view text);
/// Returns the shortest text that parses to the same number: "0.1", "-9.81", "1e+20".
std::string number_text(double value);

/// Encodes characters that OSC forbids in addresses (and '%') as %20 style escapes, and decodes them.
std::string escape_name(std::string_view name);
std::string unescape_name(std::string_view part);

/// Checks a name that a user gives: 1 to 128 bytes of printable UTF-8. Returns an error message, or nullopt if it is
/// valid.
std::optional<std::string> name_error(std::string_view name);

/// Splits the text at the separator, including empty pieces.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace limber
