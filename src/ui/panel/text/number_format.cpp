// Tries fewer and fewer digits, in plain and in scientific form.
#include "ui/panel/text/number_format.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

namespace limber::panel {

namespace {

constexpr int kMinPlainExponent = -4;  // smaller numbers are in scientific form: 1.2e-5
constexpr int kMaxPlainExponent = 6;   // and larger ones: 1.2e7
constexpr double kMaxFixed = 1e15;     // larger numbers have no fixed decimals

// Removes zeros at the end of the decimals.
void strip_zeros(std::string& text) {
  if (text.find('.') == std::string::npos) return;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
}

struct Scientific {
  std::string mantissa;
  int exponent = 0;
  std::string text() const { return fmt::format("{}e{}", mantissa, exponent); }
};

Scientific scientific(double value, int digits) {
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t e = text.find('e');
  Scientific result{text.substr(0, e), std::atoi(text.c_str() + e + 1)};
  strip_zeros(result.mantissa);
  return result;
}

// The plain form has all digits before the point.
std::string plain(double value, int digits, int exponent) {
  std::string text = fmt::format("{:.{}f}", value, std::max(digits - 1 - exponent, 0));
  strip_zeros(text);
  return text;
}

bool is_plain(int exponent, const NumberFormat& format) {
  return format.integer ? exponent >= 0 : exponent >= kMinPlainExponent && exponent <= kMaxPlainExponent;
}

// The number with a fixed number of decimals, or fewer if they don't fit; empty if it doesn't fit without them.
template <class Fits>
std::string with_decimals(double value, int decimals, const Fits& fits) {
  for (; decimals >= 0 && std::abs(value) < kMaxFixed; decimals--) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (text.front() == '-' && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
    if (fits(text)) return text;
  }
  return {};
}

// The number with as many digits as fit; with one digit, in the shortest form, if none fits.
template <class Fits>
std::string with_digits(double value, const NumberFormat& format, const Fits& fits) {
  std::string shortest;
  for (int digits = kMaxDigits; digits > 0; digits--) {
    const Scientific form = scientific(value, digits);
    const std::string texts[] = {is_plain(form.exponent, format) ? plain(value, digits, form.exponent) : form.text(),
                                 form.text()};
    for (const std::string& text : texts) {
      if (fits(text)) return text;
      if (shortest.empty() || text.size() < shortest.size()) shortest = text;
    }
  }
  return shortest;
}

}  // namespace

std::string fitted_number(double value, const NumberFormat& format, float width, const TextWidth& width_of) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (format.integer) value = std::round(value);
  if (std::abs(value) < format.zero_below) value = 0;
  const auto fits = [&](const std::string& text) { return width_of(text) <= width; };
  if (std::string text = with_decimals(value, format.decimals, fits); !text.empty()) return text;
  return value == 0 ? "0" : with_digits(value, format, fits);
}

std::string number_label(double value, const NumberFormat& format) {
  return fitted_number(value, format, std::numeric_limits<float>::infinity(), [](std::string_view) { return 0.0F; });
}

}  // namespace limber::panel
