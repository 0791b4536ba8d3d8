// Files of POSIX.
#include "base/system/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::system {

namespace {

int flags_of(OpenMode mode) {
  switch (mode) {
    case OpenMode::read:
      return O_RDONLY;
    case OpenMode::write:
      return O_WRONLY;
    case OpenMode::append:
      return O_WRONLY | O_APPEND;
    case OpenMode::append_any:
      return O_WRONLY | O_APPEND | O_CREAT;
    case OpenMode::create_new:
      return O_WRONLY | O_CREAT | O_EXCL;
    case OpenMode::replace:
      break;
  }
  return O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW;
}

std::int64_t nanoseconds(const timespec& t) { return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec; }

FileStatus status_of(const struct stat& info) {
#if defined(__APPLE__)
  const timespec modified = info.st_mtimespec;
  const timespec changed = info.st_ctimespec;
#else
  const timespec modified = info.st_mtim;
  const timespec changed = info.st_ctim;
#endif
  return {S_ISREG(info.st_mode),
          S_ISDIR(info.st_mode),
          static_cast<std::uintmax_t>(info.st_size),
          info.st_ino,
          static_cast<long>(info.st_uid),
          static_cast<unsigned>(info.st_mode) & 07777u,
          nanoseconds(modified),
          nanoseconds(changed)};
}

}  // namespace

std::string error_reason() { return std::generic_category().message(errno); }

Descriptor open_file(const std::string& path, OpenMode mode, unsigned permissions) {
  return Descriptor(open(path.c_str(), flags_of(mode) | O_CLOEXEC, static_cast<mode_t>(permissions)));
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

std::ptrdiff_t read_some(int fd, char* to, std::size_t max_bytes) {
  while (true) {
    const ssize_t n = read(fd, to, max_bytes);
    if (n >= 0 || errno != EINTR) return n;
  }
}

Result<std::string> read_file(const std::string& path, std::uintmax_t max_bytes) {
  // O_NONBLOCK: don't wait for the writer of a named pipe.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (!file.is_open() || fstat(file.fd(), &info) != 0) return Error{error_reason()};
  const FileStatus status = status_of(info);
  if (!status.file) return Error{"it is a folder or a device, not a file"};
  if (status.size > max_bytes)
    return Error{fmt::format("it has {} bytes; at most {} are read", status.size, max_bytes)};
  std::string bytes(static_cast<std::size_t>(status.size), '\0');
  std::size_t count = 0;
  while (count < bytes.size()) {
    const std::ptrdiff_t n = read_some(file.fd(), bytes.data() + count, bytes.size() - count);
    if (n < 0) return Error{error_reason()};
    if (n == 0) break;  // the file was truncated meanwhile
    count += static_cast<std::size_t>(n);
  }
  bytes.resize(count);
  return bytes;
}

bool seek_to(int fd, std::uint64_t place) { return lseek(fd, static_cast<off_t>(place), SEEK_SET) >= 0; }

bool sync_file(int fd) { return fsync(fd) == 0; }

bool sync_data(int fd) {
#if defined(__APPLE__)
  return fsync(fd) == 0;
#else
  return fdatasync(fd) == 0;
#endif
}

Result<void> replace_file(const std::string& path, std::string_view text, unsigned permissions) {
  const Descriptor file = open_file(path, OpenMode::replace, permissions);
  if (!file.is_open() || !write_all(file.fd(), text)) return Error{error_reason()};
  if (fchmod(file.fd(), static_cast<mode_t>(permissions)) != 0 || !sync_file(file.fd())) return Error{error_reason()};
  return {};
}

void sync_folder(const std::string& file) {
  const std::filesystem::path path(file);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.is_open()) (void)fsync(opened.fd());
}

bool remove_file(const std::string& path) { return unlink(path.c_str()) == 0; }

bool link_file(const std::string& path, const std::string& second) { return link(path.c_str(), second.c_str()) == 0; }

bool make_folder(const std::string& path, unsigned permissions) {
  return mkdir(path.c_str(), static_cast<mode_t>(permissions)) == 0;
}

bool is_executable(const std::string& path) { return access(path.c_str(), X_OK) == 0; }

Result<Descriptor> lock_file(const std::string& path) {
  while (true) {
    Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!file.is_open()) return Error{fmt::format("{}: {}", printable(path), error_reason())};
    if (flock(file.fd(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) return Descriptor();
      return Error{fmt::format("{}: {}", printable(path), error_reason())};
    }
    struct stat locked {};
    struct stat named {};
    // Retry if the previous owner removed the name between open() and flock().
    if (fstat(file.fd(), &locked) == 0 && stat(path.c_str(), &named) == 0 && locked.st_ino == named.st_ino) return file;
  }
}

std::optional<FileStatus> file_status(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return std::nullopt;
  return status_of(info);
}

std::optional<FileStatus> link_status(const std::string& path) {
  struct stat info {};
  if (lstat(path.c_str(), &info) != 0) return std::nullopt;
  return status_of(info);
}

}  // namespace limber::system
