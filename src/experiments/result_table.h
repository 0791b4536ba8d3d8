// ResultTable: appends rows to a file: CSV, or JSON Lines if its name ends with .jsonl. If a write fails, or the
// program is killed, at most the last row is incomplete, and resume() removes it. [one thread]
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::experiments {

struct Cell {
  std::string text;     ///< Empty: no value.
  bool number = false;  ///< JSON has it without quotation marks.

  static Cell of(double value);
  static Cell of(std::uint64_t value);
  static Cell of(std::string text) { return {std::move(text), false}; }
};

class ResultTable {
 public:
  ResultTable() = default;
  /// Creates the file. For CSV, writes the names of the columns. If the file exists and `overwrite` is false, fails
  /// with an error that ends with `advice`.
  Result<void> create(const std::string& path, std::vector<std::string> columns, bool overwrite,
                      std::string_view advice);
  /// Opens the file of an earlier run, removes an incomplete last row, and returns the texts of the cells of all rows.
  /// Fails if the file has other columns.
  Result<std::vector<std::vector<std::string>>> resume(const std::string& path, std::vector<std::string> columns);
  /// Writes rows as CSV to this function instead of a file. It returns false on failure.
  void write_to(std::function<bool(std::string_view)> write, std::vector<std::string> columns);

  /// Appends a row, with one cell per column.
  Result<void> append(const std::vector<Cell>& cells);
  /// Waits until everything is written to the disk.
  Result<void> finish();
  /// True if a row could not be written.
  bool failed() const { return failed_; }

 private:
  void set_file(const std::string& path, std::vector<std::string> columns);
  std::vector<Cell> header() const;
  Result<void> write(std::string_view text);
  Error write_error() const;
  std::string line_of(const std::vector<Cell>& cells) const;

  std::string path_;
  bool json_ = false;
  bool failed_ = false;
  std::vector<std::string> columns_;
  system::Descriptor file_;
  std::function<bool(std::string_view)> write_;
};

}  // namespace limber::experiments
