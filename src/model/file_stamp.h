// FileStamp: what a file was when it was read, so that one can tell whether it still is that. [any]
#pragma once

#include <cstdint>
#include <string>

namespace limber {

class FileStamp {
 public:
  /// Of a file that can't be read: like no file's.
  FileStamp() = default;
  explicit FileStamp(const std::string& path);

  /// Whether the file still holds what it held. Only where its size and times leave a doubt it is read; what that finds
  /// is kept. A new time on the old content changes nothing.
  bool holds(const std::string& path);

  bool readable() const { return readable_; }
  /// hash_bytes of all that the file holds; 0 when it can't be read.
  std::uint64_t content() const { return content_; }
  /// By content.
  bool operator==(const FileStamp& other) const { return readable_ == other.readable_ && content_ == other.content_; }

 private:
  struct Outside {  // what the file system tells
    std::uintmax_t size = 0;
    std::uint64_t inode = 0;
    std::int64_t modified = 0;  // ns
    std::int64_t changed = 0;
    bool operator==(const Outside&) const = default;
  };
  static bool ask(const std::string& path, Outside& out);

  Outside outside_;
  std::uint64_t content_ = 0;
  bool readable_ = false;
  bool settled_ = false;  // old enough for its times to tell of the next change
};

}  // namespace limber
