// Evaluation: what came of a text that somebody at a console gave to the running scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace limber {

struct Evaluation {
  enum class Kind : std::uint8_t {
    done,        ///< It ran and has no value.
    value,       ///< `text` shows its value, or its values with tabs between.
    error,       ///< `text`: console:line: what, the source line, the way there. What ran before the error stays done.
    incomplete,  ///< The text may become a chunk when more is written; nothing was run.
    names,       ///< `text`: words that may stand at the end of the text, one a line, sorted.
  };
  Kind kind = Kind::done;
  std::string text;
  std::size_t word = 0;          ///< Of `names`: bytes at the text's end that they would replace.
  std::uint64_t log_before = 0;  ///< Lines of the log after this one,
  std::uint64_t log_after = 0;   ///< up to this one, came while it ran: what it printed.
};

/// Longest text that is evaluated, and longest that is answered, bytes.
inline constexpr std::size_t kMostEvaluated = 65536;

}  // namespace limber
