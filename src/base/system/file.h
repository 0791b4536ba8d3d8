// Low-level files: opening, reading, writing, syncing to disk, locks, and status. Functions that don't return a Result
// set errno on failure. [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::system {

/// Returns the system's message for errno.
std::string error_reason();

enum class OpenMode : std::uint8_t {
  read,
  write,       ///< Opens an existing file without truncating it.
  append,      ///< Appends to an existing file.
  append_any,  ///< Appends; creates the file if it does not exist.
  create_new,  ///< Fails with EEXIST if the name exists.
  replace,     ///< Truncates or creates the file; fails if the name is a symbolic link.
};

/// Opens a file. Child processes do not inherit it. `permissions` apply if the file is created.
Descriptor open_file(const std::string& path, OpenMode mode, unsigned permissions = 0644);

/// Writes all bytes; continues after interruptions by signals.
bool write_all(int fd, std::string_view bytes);
/// Reads up to `max_bytes` bytes. Returns 0 at the end of the file, -1 on error.
std::ptrdiff_t read_some(int fd, char* to, std::size_t max_bytes);
bool seek_to(int fd, std::uint64_t place);
/// Reads a regular file of at most `max_bytes` bytes. Errors (without the path): not found, a folder or device, too
/// large, not readable. Blocks for disk access only.
Result<std::string> read_file(const std::string& path, std::uintmax_t max_bytes);
/// Waits until the file is written to the disk.
bool sync_file(int fd);
/// Like sync_file(), but without the file's times if the system distinguishes this.
bool sync_data(int fd);

/// Replaces a file, which no other program uses, by the text and waits until it is written to the disk. The error is
/// the system's message.
Result<void> replace_file(const std::string& path, std::string_view text, unsigned permissions);
/// Waits until a file's directory entry is written to the disk. Ignores errors.
void sync_folder(const std::string& file);

/// Removes a file or link, not a folder.
bool remove_file(const std::string& path);
/// Creates a hard link. Fails with EEXIST if the name exists, with EPERM if the file system has no hard links.
bool link_file(const std::string& path, const std::string& second);
bool make_folder(const std::string& path, unsigned permissions);
/// True if this user may execute it.
bool is_executable(const std::string& path);

/// Creates the file if necessary and locks it until the descriptor is closed or the program exits. Returns a closed
/// descriptor if another program has the lock.
Result<Descriptor> lock_file(const std::string& path);

struct FileStatus {
  bool file = false;  ///< A regular file.
  bool folder = false;
  std::uintmax_t size = 0;
  std::uint64_t inode = 0;
  long owner = 0;             ///< User id.
  unsigned permissions = 0;   ///< Bits 07777.
  std::int64_t modified = 0;  ///< ns since 1970.
  std::int64_t changed = 0;   ///< Time of the last change of content or status (permissions, links), ns since 1970.
};
/// Returns nullopt on error, with errno set.
std::optional<FileStatus> file_status(const std::string& path);
/// Like file_status(), but does not follow a symbolic link.
std::optional<FileStatus> link_status(const std::string& path);

}  // namespace limber::system
