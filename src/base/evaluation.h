// Evaluation: the result of code or a completion request that a console sent to the running scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace limber {

struct Evaluation {
  enum class Kind : std::uint8_t {
    done,        ///< The code ran and returned nothing.
    value,       ///< `text`: the returned values, separated by tabs.
    error,       ///< `text`: console:line: message, source line, traceback. Effects before the error remain.
    incomplete,  ///< The code is incomplete and may continue on the next line; nothing was run.
    names,       ///< `text`: completions of the last word, one per line, sorted.
  };
  Kind kind = Kind::done;
  std::string text;
  std::size_t word = 0;          ///< For `names`: length in bytes of the word that the completions replace.
  std::uint64_t log_before = 0;  ///< Log lines after this number,
  std::uint64_t log_after = 0;   ///< up to and including this one, were written while the code ran.
};

/// Maximum length of the code and of the result, in bytes.
inline constexpr std::size_t kMaxEvaluatedBytes = 65536;

}  // namespace limber
