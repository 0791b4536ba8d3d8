// Folder events with inotify.
#include "base/system/folder_events.h"

#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace limber::system {

namespace {

constexpr std::uint32_t kEvents =
    IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;

}  // namespace

FolderEvents::FolderEvents() : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}

int FolderEvents::add(const std::string& folder) { return inotify_add_watch(fd(), folder.c_str(), kEvents); }

void FolderEvents::remove(int number) { inotify_rm_watch(fd(), number); }

std::vector<FolderEvent> FolderEvents::read() {
  std::vector<FolderEvent> list;
  alignas(inotify_event) std::array<char, 16384> block;
  for (ssize_t size = 0; (size = ::read(fd(), block.data(), block.size())) > 0;) {
    for (ssize_t at = 0; at < size;) {
      const auto& event = *reinterpret_cast<const inotify_event*>(block.data() + at);
      at += static_cast<ssize_t>(sizeof event + event.len);
      const bool is_folder = (event.mask & IN_ISDIR) != 0;
      list.push_back({(event.mask & IN_Q_OVERFLOW) != 0 ? -1 : event.wd, event.len > 0 ? event.name : "",
                      (event.mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED)) != 0, is_folder,
                      (event.mask & IN_CREATE) != 0 && !is_folder});
    }
  }
  return list;
}

// File systems without events for remote changes: NFS, 9P, SMB, CIFS, FUSE (with virtiofs), Coda, AFS.
bool reports_changes(const std::string& folder) {
  struct statfs info {};
  if (statfs(folder.c_str(), &info) != 0) return true;
  constexpr std::array<std::uint32_t, 8> kTypes = {0x6969,     0x01021997, 0x517b,     0xff534d42,
                                                   0xfe534d42, 0x65735546, 0x73757245, 0x5346414f};
  return std::find(kTypes.begin(), kTypes.end(), static_cast<std::uint32_t>(info.f_type)) == kTypes.end();
}

}  // namespace limber::system
