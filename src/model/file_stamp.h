// FileStamp: the status and content hash of a file at the time it was read, to detect later changes. [any]
#pragma once

#include <cstdint>
#include <string>

namespace limber::model {

class FileStamp {
 public:
  /// The stamp of a file that can't be read.
  FileStamp() = default;
  explicit FileStamp(const std::string& path);

  /// True if the file's content is unchanged. Compares size, inode and times first, and hashes the content only if they
  /// differ or are too recent to be reliable; then updates the stamp. A changed time with equal content is no change.
  bool is_current(const std::string& path);

  bool readable() const { return readable_; }
  /// hash_bytes() of the content; 0 if the file can't be read.
  std::uint64_t content_hash() const { return content_hash_; }
  /// Compares content only.
  bool operator==(const FileStamp& other) const {
    return readable_ == other.readable_ && content_hash_ == other.content_hash_;
  }

 private:
  struct FileStatus {  // status reported by the file system
    std::uintmax_t size = 0;
    std::uint64_t inode = 0;
    std::int64_t modified = 0;  // mtime, ns
    std::int64_t changed = 0;   // ctime, ns
    bool operator==(const FileStatus&) const = default;
  };
  static bool query_status(const std::string& path, FileStatus& out);

  FileStatus status_;
  std::uint64_t content_hash_ = 0;
  bool readable_ = false;
  bool times_reliable_ = false;  // the file was old enough when it was read that any later change alters its times
};

}  // namespace limber::model
