// Events of folders, or looking at the files; then the content decides.
#include "app/file_watch.h"

#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

namespace limber {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kEvents =
    IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;

// file systems that others change behind the kernel's back: NFS, 9P, SMB, CIFS, FUSE (virtiofs is one), Coda, AFS
bool changes_unheard(const std::string& folder) {
  struct statfs info {};
  if (statfs(folder.c_str(), &info) != 0) return false;
  constexpr std::array<std::uint32_t, 8> kTypes = {0x6969,     0x01021997, 0x517b,     0xff534d42,
                                                   0xfe534d42, 0x65735546, 0x73757245, 0x5346414f};
  return std::find(kTypes.begin(), kTypes.end(), static_cast<std::uint32_t>(info.f_type)) != kTypes.end();
}

}  // namespace

FileWatch::FileWatch(Way way) : way_(way) {
  if (way_ == Way::events) inotify_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (inotify_ < 0) way_ = Way::polling;
}

FileWatch::~FileWatch() {
  if (inotify_ >= 0) close(inotify_);
}

void FileWatch::watch(const std::vector<SourceFile>& files, Time now) {
  const std::map<std::string, FileStamp> before = std::exchange(files_, {});
  for (const SourceFile& file : files) files_[file.path];
  arm();  // before they are read: no save falls between the two
  bool differs = false;
  for (const SourceFile& file : files) {
    FileStamp& stamp = files_[file.path];
    const auto known = before.find(file.path);
    stamp = known != before.end() ? known->second : FileStamp(file.path);
    if (known != before.end() || !file.content || stamp.content() == *file.content) continue;
    // one that was changed since it was read is like none
    stamp = FileStamp();
    differs = true;
  }
  if (differs) settle_at_ = now + kQuiet;
  if (way_ == Way::polling && !next_look_) next_look_ = now + kLook;
}

// the folder that a file stands in, or the nearest one above that exists: what is made there may become it
void FileWatch::want(std::map<std::string, std::set<std::string>>& folders, const std::string& file) const {
  fs::path path(file);
  std::error_code fault;
  while (path.has_parent_path() && path.parent_path() != path) {
    const fs::path folder = path.parent_path();
    if (fs::is_directory(folder, fault)) {
      folders[folder.string()].insert(path.filename().string());
      return;
    }
    path = folder;
  }
}

void FileWatch::arm() {
  if (inotify_ < 0) return;
  std::map<std::string, std::set<std::string>> wanted;
  for (const auto& [file, stamp] : files_) {
    want(wanted, file);
    // a link's target is what gets written
    std::error_code fault;
    const fs::path real = fs::canonical(file, fault);
    if (!fault && real != file) want(wanted, real.string());
  }
  std::map<int, Folder> folders;
  for (const auto& [folder, names] : wanted) {
    const int number = inotify_add_watch(inotify_, folder.c_str(), kEvents);
    if (number < 0 || changes_unheard(folder)) way_ = Way::polling;
    if (number < 0) continue;
    // two paths may lead to one folder
    Folder& entry = folders[number];
    entry.path = folder;
    entry.names.insert(names.begin(), names.end());
  }
  for (const auto& [number, folder] : folders_) {
    if (!folders.contains(number)) inotify_rm_watch(inotify_, number);
  }
  folders_ = std::move(folders);
}

std::optional<FileWatch::Time> FileWatch::due() const {
  if (way_ != Way::polling) return settle_at_;
  const Time look = next_look_.value_or(Time::min());
  return settle_at_ ? std::min(*settle_at_, look) : look;
}

void FileWatch::read_events(Time now) {
  alignas(inotify_event) std::array<char, 16384> block;
  bool moved = false;
  for (ssize_t size = 0; (size = read(inotify_, block.data(), block.size())) > 0;) {
    for (ssize_t at = 0; at < size;) {
      const auto& event = *reinterpret_cast<const inotify_event*>(block.data() + at);
      at += static_cast<ssize_t>(sizeof event + event.len);
      const auto folder = folders_.find(event.wd);
      const bool lost = (event.mask & IN_Q_OVERFLOW) != 0;
      const bool itself = (event.mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED)) != 0;
      if (folder == folders_.end() && !lost) continue;
      if (itself) {
        inotify_rm_watch(inotify_, event.wd);
        folders_.erase(folder);
        moved = true;
      } else if (!lost && !folder->second.names.contains(event.len > 0 ? event.name : "")) {
        continue;
      }
      moved |= (event.mask & IN_ISDIR) != 0;
      const bool open_file = (event.mask & IN_CREATE) != 0 && (event.mask & IN_ISDIR) == 0;
      settle_at_ = now + (open_file ? kOpenFile : kQuiet);
    }
  }
  if (moved) arm();
}

void FileWatch::look(Time now) {
  if (!next_look_) next_look_ = now;
  if (now < *next_look_) return;
  next_look_ = now + kLook;
  if (settle_at_) return;
  const bool differs =
      std::any_of(files_.begin(), files_.end(), [](auto& file) { return !file.second.holds(file.first); });
  if (differs) settle_at_ = now + kQuiet;
}

// where nobody tells that a file was closed: whether one changes yet
bool FileWatch::still_moving(Time now) {
  std::map<std::string, FileStamp> stamps;
  for (const auto& [path, stamp] : files_) stamps.emplace(path, FileStamp(path));
  const bool moving = stamps != seen_moving_;
  seen_moving_ = std::move(stamps);
  if (moving) settle_at_ = now + kQuiet;
  return moving;
}

std::vector<std::string> FileWatch::take_changed() {
  std::vector<std::string> changed;
  for (auto& [path, stamp] : files_) {
    if (!stamp.holds(path) && FileStamp(path).readable()) changed.push_back(path);
  }
  if (changed.empty()) return changed;
  // whoever is told now reads all of them: what is gone or back since counts from here
  for (auto& [path, stamp] : files_) stamp = FileStamp(path);
  return changed;
}

std::vector<std::string> FileWatch::poll(Time now) {
  if (inotify_ >= 0) read_events(now);
  if (way_ == Way::polling) look(now);
  if (!settle_at_ || now < *settle_at_) return {};
  if (way_ == Way::polling && still_moving(now)) return {};
  settle_at_.reset();
  seen_moving_.clear();
  arm();
  return take_changed();
}

}  // namespace limber
