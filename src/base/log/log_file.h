// LogFile: a log file with rotation: FILE, then FILE.1 (the newest of the old files), FILE.2 and so on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/log/output_writer.h"
#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber {

struct LogRotation {
  std::uintmax_t bytes = 10'000'000;  ///< Maximum size of a file, unless its first line is larger.
  int old_files = 5;                  ///< Number of old files.
};

class LogFile : public OutputDevice {
 public:
  /// Opens the file for appending, or creates it. Error: it can't be written. [any]
  static Result<std::unique_ptr<LogFile>> open(const std::string& path, LogRotation rotation);

  /// Writes to the file. Starts a new file first if this one is full, was removed, or was renamed by another program.
  /// If that fails, writes nothing, so that the log never exceeds its configured size. [writer]
  system::Written write(std::string_view bytes, std::chrono::nanoseconds limit) override;

 private:
  LogFile(std::string path, LogRotation rotation) : path_(std::move(path)), rotation_(rotation) {}

  int begin_line(std::size_t size);
  int reopen();
  int rotate();

  std::string path_;
  LogRotation rotation_;
  system::Descriptor file_;
  std::uint64_t inode_ = 0;
  std::uintmax_t size_ = 0;
  bool in_line_ = false;  // the last byte written is not a newline
};

}  // namespace limber
