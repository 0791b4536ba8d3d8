// ResultTable: a table that grows by one row after the other, in a file: CSV, or JSON Lines if its name ends with
// .jsonl. A row that was written stays; if a write fails, or the program is killed, at most the last row is incomplete,
// and resuming removes it. [one thread]
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::experiments {

/// A cell: a number (or nothing) is written without quotes in JSON.
struct Cell {
  std::string text;
  bool number = false;

  static Cell of(double value);
  static Cell of(std::uint64_t value);
  static Cell of(std::string text) { return {std::move(text), false}; }
  bool operator==(const Cell&) const = default;
};

class ResultTable {
 public:
  ResultTable() = default;
  /// Creates the file; fails if it exists and not `overwrite`. For CSV, writes the names of the columns.
  Result<void> create(const std::string& path, std::vector<std::string> columns, bool overwrite);
  /// Opens a file that a previous run has left, removes an incomplete last row, and returns the texts of the cells of
  /// all rows. Fails if it has other columns.
  Result<std::vector<std::vector<std::string>>> resume(const std::string& path, std::vector<std::string> columns);
  /// Writes rows to this function instead of a file.
  void write_to(std::function<bool(std::string_view)> write, std::vector<std::string> columns);

  /// Appends a row, with one cell per column.
  Result<void> append(const std::vector<Cell>& cells);
  /// Waits until everything is written to the disk.
  Result<void> finish();
  /// True if a row could not be written.
  bool failed() const { return failed_; }

 private:
  Result<void> write(std::string_view text);
  std::string line_of(const std::vector<Cell>& cells) const;

  std::string path_;
  bool json_ = false;
  bool failed_ = false;
  std::vector<std::string> columns_;
  system::Descriptor file_;
  std::function<bool(std::string_view)> write_;
};

}  // namespace limber::experiments
