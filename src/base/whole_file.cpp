// Written, synced; the caller renames.
#include "base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "base/descriptor.h"

namespace limber {

Result<void> write_whole(const std::string& path, std::string_view text, mode_t mode) {
  const auto reason = [] { return Error{std::generic_category().message(errno)}; };
  const Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, mode));
  if (!file.open()) return reason();
  while (!text.empty()) {
    const ssize_t n = write(file.fd(), text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return reason();
    text.remove_prefix(static_cast<std::size_t>(n));
  }
  if (fchmod(file.fd(), mode) != 0 || fsync(file.fd()) != 0) return reason();
  return {};
}

void sync_folder(const std::string& file) {
  const std::filesystem::path path(file);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.open()) (void)fsync(opened.fd());
}

}  // namespace limber
