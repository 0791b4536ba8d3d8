// AtomicFile: a file that is replaced atomically: it is written to a temporary file in the same folder, renamed at the
// end.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace limber::exporter {

/// The name of the temporary file of `path`; it contains the process id, so that two processes never share one.
std::string temporary_name(const std::string& path);

class AtomicFile {
 public:
  /// Does not touch the disk before open().
  explicit AtomicFile(const std::string& path) : AtomicFile(path, temporary_name(path)) {}
  /// `temporary_path`: path of the temporary file.
  AtomicFile(std::string path, std::string temporary_path);
  /// Deletes the temporary file if finish() did not succeed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Creates the temporary file.
  Result<void> open();
  /// Appends bytes, buffered. No file descriptor is open between calls, so thousands of files can be unfinished
  /// at the same time.
  Result<void> write(std::string_view bytes);
  /// Overwrites the bytes at offset `at`.
  Result<void> patch(std::uint64_t at, std::string_view bytes);
  /// Writes all buffered bytes to the temporary file.
  Result<void> flush();
  /// Flushes, syncs to disk and renames the file to its final name.
  Result<void> finish();

  /// Number of bytes written so far.
  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }
  /// Name of the temporary file.
  const std::string& temporary_path() const { return temporary_path_; }

 private:
  Error failed() const;

  std::string path_;
  std::string temporary_path_;
  std::string buffer_;
  std::uint64_t size_ = 0;
  bool open_ = false;
};

}  // namespace limber::exporter
