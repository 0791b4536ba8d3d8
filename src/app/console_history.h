// ConsoleHistory: the lines that were typed into consoles, in a plain text file of the user's state folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limber {

class ConsoleHistory {
 public:
  static constexpr std::size_t kMostLines = 1000;
  static constexpr std::size_t kMostBytes = 4096;  ///< Of a line; longer ones are not kept.

  /// $XDG_STATE_HOME/limber/console_history, else below ~/.local/state; empty when there is no home.
  static std::string default_file();

  /// Reads what the file has: whatever is no line of text in it is passed over. Without a file it is empty, and with an
  /// empty name nothing is kept.
  explicit ConsoleHistory(std::string file);

  const std::vector<std::string>& lines() const { return lines_; }
  /// Keeps a line, in the file at once, unless it is blank, the same as the last, or too long. A file that can't be
  /// written is no reason to stop a console.
  void add(std::string_view line);

 private:
  void rewrite() const;

  std::string file_;
  std::vector<std::string> lines_;
};

}  // namespace limber
