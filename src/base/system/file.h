// Files below the level of streams: how they are opened, that bytes have reached the disk, locks, and status. Functions
// without a Result leave the reason in errno. [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::system {

enum class OpenMode : std::uint8_t {
  read,
  write,       ///< What is there stays until it is overwritten.
  append,      ///< At the end of an existing file.
  append_any,  ///< At the end; the file is created when it does not exist.
  create_new,  ///< Fails with EEXIST when something has the name.
  replace,     ///< Emptied or created; fails when the name is a symbolic link.
};

/// Child processes do not inherit it. `permissions` count where the file is created.
Descriptor open_file(const std::string& path, OpenMode mode, unsigned permissions = 0644);

/// Writes everything, also when signals come in between.
bool write_all(int fd, std::string_view bytes);
/// Reads up to `most` bytes; 0: the end, -1: an error.
std::ptrdiff_t read_some(int fd, char* to, std::size_t most);
bool seek_to(int fd, std::uint64_t place);
/// The bytes of a regular file that has at most so many. The error is the reason, without the path: it does not exist,
/// is a folder or a device, is too large, can't be read. Doesn't wait for anything but the disk.
Result<std::string> read_file(const std::string& path, std::uintmax_t most);
/// Waits until the file is on the disk.
bool sync_file(int fd);
/// The same; without what only its times tell, where the system makes a difference.
bool sync_data(int fd);

/// Writes the text to a file that belongs to the caller alone, and waits until it is on the disk. The error is the
/// system's reason.
Result<void> write_whole(const std::string& path, std::string_view text, unsigned permissions);
/// Waits until the name of a file is on the disk. Reports nothing where that is impossible.
void sync_folder(const std::string& file);

/// Removes a name that is not a folder's.
bool remove_file(const std::string& path);
/// Gives a file a second name; fails with EEXIST when something has it, with EPERM where the file system has none.
bool link_file(const std::string& path, const std::string& second);
bool make_folder(const std::string& path, unsigned permissions);
/// Whether this user may run it as a program.
bool is_executable(const std::string& path);

/// Locks a file of that name, which is created when it does not exist, until the descriptor is closed or the program
/// ends. A closed descriptor: another program has the lock.
Result<Descriptor> lock_file(const std::string& path);

struct FileStatus {
  bool file = false;  ///< A regular one.
  bool folder = false;
  std::uintmax_t size = 0;
  std::uint64_t inode = 0;
  long owner = 0;             ///< User number.
  unsigned permissions = 0;   ///< 07777.
  std::int64_t modified = 0;  ///< ns since 1970.
  std::int64_t changed = 0;   ///< The same, of its status: permissions, links, content.
};
/// Nothing: errno says why.
std::optional<FileStatus> file_status(const std::string& path);
/// The same; of a symbolic link itself.
std::optional<FileStatus> link_status(const std::string& path);

}  // namespace limber::system
