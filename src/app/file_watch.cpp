// Events of folders, or looking at the files; then the content decides.
#include "app/file_watch.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace limber {

namespace {

namespace fs = std::filesystem;

/// Paths to one file, each link on the way making another: links may lead in a circle.
constexpr std::size_t kMostPaths = 100;

}  // namespace

FileWatch::FileWatch(Way way) : way_(way) {
  if (way_ == Way::events) events_.emplace();
  if (events_ && !events_->available()) events_.reset();
  if (!events_) way_ = Way::polling;
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

// The entry in each folder on the way to a file, and to what links on the way lead to: another entry in its place
// brings another file.
void FileWatch::want(std::map<std::string, std::set<std::string>>& folders, std::set<std::string>& seen,
                     const fs::path& file) const {
  if (!seen.insert(file.string()).second || seen.size() > kMostPaths) return;
  std::error_code fault;
  for (fs::path path = file; path.has_parent_path() && path.parent_path() != path; path = path.parent_path()) {
    const fs::path folder = path.parent_path();
    if (!fs::is_directory(folder, fault)) continue;
    folders[folder.string()].insert(path.filename().string());
    if (!fs::is_symlink(path, fault)) continue;
    const fs::path target = (fs::canonical(folder, fault) / fs::read_symlink(path, fault)).lexically_normal();
    if (!fault) want(folders, seen, path == file ? target : target / file.lexically_relative(path));
  }
}

void FileWatch::arm() {
  if (!events_) return;
  std::map<std::string, std::set<std::string>> wanted;
  for (const auto& [file, stamp] : files_) {
    std::set<std::string> seen;
    want(wanted, seen, file);
  }
  std::map<int, Folder> folders;
  for (const auto& [folder, names] : wanted) {
    const int number = events_->add(folder);
    if (number < 0 || !system::reports_changes(folder)) way_ = Way::polling;
    if (number < 0) continue;
    // two paths may lead to one folder
    Folder& entry = folders[number];
    entry.path = folder;
    entry.names.insert(names.begin(), names.end());
  }
  for (const auto& [number, folder] : folders_) {
    if (!folders.contains(number)) events_->remove(number);
  }
  folders_ = std::move(folders);
}

std::optional<FileWatch::Time> FileWatch::due() const {
  if (way_ != Way::polling) return settle_at_;
  const Time look = next_look_.value_or(Time::min());
  return settle_at_ ? std::min(*settle_at_, look) : look;
}

void FileWatch::read_events(Time now) {
  bool moved = false;
  for (const system::FolderEvent& event : events_->read()) {
    const auto folder = folders_.find(event.folder);
    const bool lost = event.folder < 0;
    if (folder == folders_.end() && !lost) continue;
    if (event.folder_gone) {
      events_->remove(event.folder);
      folders_.erase(folder);
      moved = true;
    } else if (!lost && !folder->second.names.contains(event.name)) {
      continue;
    }
    moved |= event.entry_is_folder;
    settle_at_ = now + (event.may_be_open ? kOpenFile : kQuiet);
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
  if (events_) read_events(now);
  if (way_ == Way::polling) look(now);
  if (!settle_at_ || now < *settle_at_) return {};
  if (way_ == Way::polling && still_moving(now)) return {};
  settle_at_.reset();
  seen_moving_.clear();
  arm();
  return take_changed();
}

}  // namespace limber
