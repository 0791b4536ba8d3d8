// LogFile: a log on disk that is rotated: FILE, then FILE.1 (the newest of the old ones), FILE.2 and so on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/output_writer.h"
#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber {

struct LogRotation {
  std::uintmax_t bytes = 10'000'000;  ///< A file is not larger, unless its first line is.
  int kept = 5;                       ///< Old files.
};

class LogFile : public OutputDevice {
 public:
  /// Appends to the file, or creates it. The error says why it can't be written. [any]
  static Result<std::unique_ptr<LogFile>> open(const std::string& path, LogRotation rotation);

  /// Also begins a new file when this one is full, was removed, or was renamed by another program. Where that fails it
  /// writes nothing, so that the log never takes more of the disk than it may. [writer]
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
