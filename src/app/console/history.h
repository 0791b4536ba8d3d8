// ConsoleHistory: lines entered in consoles, saved in a plain text file in the user's state folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limber::app {

/// [main]
class ConsoleHistory {
 public:
  static constexpr std::size_t kMaxLines = 1000;
  static constexpr std::size_t kMaxLineBytes = 4096;  ///< Maximal length of a line; longer ones are not saved.

  /// Returns $XDG_STATE_HOME/limber/console_history, else the same below ~/.local/state; empty if there is no home
  /// folder.
  static std::string default_file();

  /// Loads the file and skips lines that are not printable text. A missing file gives an empty history; with an empty
  /// name nothing is saved.
  explicit ConsoleHistory(std::string file);

  const std::vector<std::string>& lines() const { return lines_; }
  /// Appends a line and writes it to the file at once, unless it is blank, repeats the last line, or is too long. Write
  /// errors are ignored: they must not stop a console.
  void add(std::string_view line);

 private:
  void rewrite() const;

  std::string file_;
  std::vector<std::string> lines_;
};

}  // namespace limber::app
