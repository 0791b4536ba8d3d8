// Parses numbers independently of the locale.
#include "model/xml_numbers.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "base/text.h"

namespace limber::model {

namespace {

bool has_negative_exponent(std::string_view digits) {
  const std::size_t e = digits.find_first_of("eE");
  return e != std::string_view::npos && e + 1 < digits.size() && digits[e + 1] == '-';
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string printable_excerpt(std::string_view text) {
  constexpr std::size_t kMaxBytes = 60;
  return printable(text.substr(0, kMaxBytes)) + (text.size() > kMaxBytes ? "…" : "");
}

NumberText read_number(std::string_view text) {
  if (text.empty()) return {0, "is empty", "Write a number."};
  if (text.find("${") != std::string_view::npos || text.find("$(") != std::string_view::npos) {
    return {0, "is a xacro expression", "Run xacro on the file first."};
  }
  std::string_view digits = text;
  if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (fault == std::errc::result_out_of_range && whole) {
    // an underflow is 0, an overflow is an error
    if (has_negative_exponent(digits)) return {0, "", ""};
    return {0, "is too large for a number", "Write a number of a sensible size."};
  }
  if (fault != std::errc() || !whole) {
    if (text.find(',') != std::string_view::npos) return {0, "is not a number", "Write a decimal point, not a comma."};
    return {0, "is not a number", "Write a plain decimal number such as 1.5 or 2e-3."};
  }
  if (!std::isfinite(value)) return {0, "is not finite", "Write a finite number."};
  return {value, "", ""};
}

}  // namespace limber::model
