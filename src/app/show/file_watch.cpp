// Waits for events of folders or polls; then compares file contents.
#include "app/show/file_watch.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace limber::app {

namespace {

namespace fs = std::filesystem;

/// Limit of the paths that lead to one file through links: links may form a cycle.
constexpr std::size_t kMaxPaths = 100;

}  // namespace

FileWatch::FileWatch(Mode mode) : mode_(mode) {
  if (mode_ == Mode::events) events_.emplace();
  if (events_ && !events_->available()) events_.reset();
  if (!events_) mode_ = Mode::polling;
}

void FileWatch::watch(const std::vector<script::SourceFile>& files, Time now) {
  const std::map<std::string, model::FileStamp> before = std::exchange(files_, {});
  for (const script::SourceFile& file : files) files_[file.path];
  update_watches();  // before reading the files, so that no save is missed in between
  bool differs = false;
  for (const script::SourceFile& file : files) {
    model::FileStamp& stamp = files_[file.path];
    const auto known = before.find(file.path);
    stamp = known != before.end() ? known->second : model::FileStamp(file.path);
    if (known != before.end() || !file.content || stamp.content_hash() == *file.content) continue;
    // changed since it was read: treated as unknown
    stamp = model::FileStamp();
    differs = true;
  }
  if (differs) quiet_at_ = now + kQuietPeriod;
  if (mode_ == Mode::polling && !next_poll_) next_poll_ = now + kPollInterval;
}

// Adds the entries to watch in each folder on the path to a file, and on the path of each link's target: replacing any
// of these entries changes the file.
void FileWatch::add_watched(std::map<std::string, std::set<std::string>>& folders, std::set<std::string>& visited,
                            const fs::path& file) const {
  if (!visited.insert(file.string()).second || visited.size() > kMaxPaths) return;
  std::error_code error;
  for (fs::path path = file; path.has_parent_path() && path.parent_path() != path; path = path.parent_path()) {
    const fs::path folder = path.parent_path();
    if (!fs::is_directory(folder, error)) continue;
    folders[folder.string()].insert(path.filename().string());
    if (!fs::is_symlink(path, error)) continue;
    const fs::path target = (fs::canonical(folder, error) / fs::read_symlink(path, error)).lexically_normal();
    if (!error) add_watched(folders, visited, path == file ? target : target / file.lexically_relative(path));
  }
}

void FileWatch::update_watches() {
  if (!events_) return;
  std::map<std::string, std::set<std::string>> wanted;
  for (const auto& [file, stamp] : files_) {
    std::set<std::string> visited;
    add_watched(wanted, visited, file);
  }
  std::map<int, Folder> folders;
  for (const auto& [folder, names] : wanted) {
    const int number = events_->add(folder);
    if (number < 0 || !system::reports_changes(folder)) mode_ = Mode::polling;
    if (number < 0) continue;
    // two paths may lead to the same folder
    Folder& entry = folders[number];
    entry.path = folder;
    entry.names.insert(names.begin(), names.end());
  }
  for (const auto& [number, folder] : folders_) {
    if (!folders.contains(number)) events_->remove(number);
  }
  folders_ = std::move(folders);
}

std::optional<FileWatch::Time> FileWatch::next_poll() const {
  if (mode_ != Mode::polling) return quiet_at_;
  const Time poll_time = next_poll_.value_or(Time::min());
  return quiet_at_ ? std::min(*quiet_at_, poll_time) : poll_time;
}

void FileWatch::read_events(Time now) {
  bool moved = false;
  for (const system::FolderEvent& event : events_->read()) {
    const auto folder = folders_.find(event.folder);
    const bool lost = event.folder < 0;
    if (folder == folders_.end() && !lost) continue;
    if (event.folder_removed) {
      events_->remove(event.folder);
      folders_.erase(folder);
      moved = true;
    } else if (!lost && !folder->second.names.contains(event.name)) {
      continue;
    }
    moved |= event.entry_is_folder;
    quiet_at_ = now + (event.may_be_open ? kOpenFileQuietPeriod : kQuietPeriod);
  }
  if (moved) update_watches();
}

void FileWatch::compare_files(Time now) {
  if (!next_poll_) next_poll_ = now;
  if (now < *next_poll_) return;
  next_poll_ = now + kPollInterval;
  if (quiet_at_) return;
  const bool differs =
      std::any_of(files_.begin(), files_.end(), [](auto& file) { return !file.second.is_current(file.first); });
  if (differs) quiet_at_ = now + kQuietPeriod;
}

// without close events: true while a file still changes
bool FileWatch::still_changing(Time now) {
  std::map<std::string, model::FileStamp> stamps;
  for (const auto& [path, stamp] : files_) stamps.emplace(path, model::FileStamp(path));
  const bool moving = stamps != last_stamps_;
  last_stamps_ = std::move(stamps);
  if (moving) quiet_at_ = now + kQuietPeriod;
  return moving;
}

std::vector<std::string> FileWatch::collect_changed() {
  std::vector<std::string> changed;
  for (auto& [path, stamp] : files_) {
    if (!stamp.is_current(path) && model::FileStamp(path).readable()) changed.push_back(path);
  }
  if (changed.empty()) return changed;
  // the caller reads all files now, so later changes count from here
  for (auto& [path, stamp] : files_) stamp = model::FileStamp(path);
  return changed;
}

std::vector<std::string> FileWatch::poll(Time now) {
  if (events_) read_events(now);
  if (mode_ == Mode::polling) compare_files(now);
  if (!quiet_at_ || now < *quiet_at_) return {};
  if (mode_ == Mode::polling && still_changing(now)) return {};
  quiet_at_.reset();
  last_stamps_.clear();
  update_watches();
  return collect_changed();
}

}  // namespace limber::app
