// LinkLine: a line that the program limber-link prints. [any]
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace limber::link {

struct LinkLine {
  double beat = 0;
  double tempo = 120;  ///< Beats per minute.
  bool playing = false;
  std::uint32_t peers = 0;  ///< Number of other programs in the session.
  double time = 0;          ///< When the beat was, s by the steady clock.
};

/// Parses "BEAT TEMPO PLAYING PEERS TIME"; nothing if the line is another one.
std::optional<LinkLine> parse_link_line(std::string_view line);

}  // namespace limber::link
