// Rotates the log file by renaming.
#include "base/log/log_file.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/text.h"

namespace limber {

namespace fs = std::filesystem;

Result<std::unique_ptr<LogFile>> LogFile::open(const std::string& path, LogRotation rotation) {
  // Resolves the path now: the working directory may be replaced later, and rotation must not rename a symbolic link.
  std::error_code fault;
  const fs::path resolved = fs::weakly_canonical(fs::absolute(path, fault), fault);
  std::unique_ptr<LogFile> log(new LogFile(fault ? path : resolved.string(), rotation));
  if (const int error = log->reopen(); error != 0) {
    const char* const fix = error == ENOENT   ? "Create its folder first"
                            : error == EINVAL ? "It must be a regular file"
                                              : "Choose another path";
    return Error{fmt::format("the log file {} can't be written: {}. {}", printable(path),
                             std::generic_category().message(error), fix)};
  }
  return log;
}

system::Written LogFile::write(std::string_view bytes, std::chrono::nanoseconds limit) {
  if (!in_line_) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size() - 1);
    if (const int error = begin_line(end + 1); error != 0) return {0, error};
  }
  const system::Written written = system::write_within(file_.fd(), bytes, limit);
  if (written.count == 0) return written;
  size_ += written.count;
  in_line_ = bytes[written.count - 1] != '\n';
  return written;
}

// Rotates or reopens the file if necessary for a line of this size. Returns 0 or an errno.
int LogFile::begin_line(std::size_t size) {
  const std::optional<system::FileStatus> now = system::file_status(path_);
  if (!now || now->inode != inode_) return reopen();
  size_ = now->size;  // another program may have emptied it
  return size_ > 0 && size_ + size > rotation_.bytes ? rotate() : 0;
}

int LogFile::reopen() {
  const std::optional<system::FileStatus> existing = system::file_status(path_);
  if (existing && !existing->file) return EINVAL;
  system::Descriptor file = system::open_file(path_, system::OpenMode::append_any);
  if (!file.is_open()) return errno;
  const std::optional<system::FileStatus> status = system::file_status(path_);
  if (!status) return errno;
  file_ = std::move(file);
  inode_ = status->inode;
  size_ = status->size;
  return 0;
}

int LogFile::rotate() {
  const auto name = [this](int number) { return number == 0 ? path_ : fmt::format("{}.{}", path_, number); };
  std::error_code fault;
  if (rotation_.old_files == 0) {
    if (!system::remove_file(path_)) return errno;
    return reopen();
  }
  for (int number = 1; number <= rotation_.old_files; number++) {
    const std::optional<system::FileStatus> old = system::link_status(name(number));
    if (old && !old->file) return EEXIST;  // not a regular file: don't overwrite it
  }
  for (int number = rotation_.old_files; number > 0; number--) {
    fs::rename(name(number - 1), name(number), fault);
    if (fault && fault != std::errc::no_such_file_or_directory) return fault.value();
  }
  return reopen();
}

}  // namespace limber
