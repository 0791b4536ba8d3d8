// Parses the lines of limber-link.
#include "net/link/link_line.h"

#include <array>
#include <cmath>

#include "base/text.h"

namespace limber::link {

std::optional<LinkLine> parse_link_line(std::string_view line) {
  std::array<double, 5> numbers{};
  std::size_t count = 0;
  for (const std::string_view word : split(line, ' ')) {
    const std::optional<double> number = parse_number(word);
    if (!number || !std::isfinite(*number) || count == numbers.size()) return std::nullopt;
    numbers[count++] = *number;
  }
  const auto& [beat, tempo, playing, peers, time] = numbers;
  if (count != numbers.size() || tempo <= 0 || peers < 0 || peers > 1e6) return std::nullopt;
  return LinkLine{beat, tempo, playing != 0, static_cast<std::uint32_t>(peers), time};
}

}  // namespace limber::link
