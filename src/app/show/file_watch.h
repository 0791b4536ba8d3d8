// FileWatch: reports which files of a set have changed, after a quiet period, for every way in which editors save. It
// watches the folders on the path of a file rather than the file, because saving may replace the file, and an update
// may replace a folder or a link. [one thread]
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/system/folder_events.h"
#include "model/file_stamp.h"
#include "script/scene/sources.h"

namespace limber::app {

/// Watches a set of files.
class FileWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// `events`: the kernel reports changes. `polling`: files are compared four times a second, on file systems for
  /// which the kernel reports none. Falls back from `events` to `polling` by itself.
  enum class Mode : std::uint8_t { events, polling };

  static constexpr auto kQuietPeriod = std::chrono::milliseconds(50);
  static constexpr auto kPollInterval = std::chrono::milliseconds(250);
  /// Quiet period of a file that was created and not closed yet: it may be incomplete.
  static constexpr auto kOpenFileQuietPeriod = std::chrono::milliseconds(500);

  explicit FileWatch(Mode mode = Mode::events);
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Replaces the set of watched files, whether they exist or not. A file with content other than the given one
  /// counts as changed.
  void watch(const std::vector<script::SourceFile>& files, Time now);
  /// File descriptor that becomes readable when something has changed; -1: none.
  int fd() const { return events_ ? events_->fd() : -1; }
  Mode mode() const { return mode_; }
  /// Returns the time at which poll() must be called even without events.
  std::optional<Time> next_poll() const;
  /// Returns the files with content changed since they were last reported, once all are quiet. A removed file is
  /// reported when it exists again. Never blocks.
  std::vector<std::string> poll(Time now);

 private:
  struct Folder {
    std::string path;
    std::set<std::string> names;  // watched entries
  };

  void update_watches();
  void add_watched(std::map<std::string, std::set<std::string>>& folders, std::set<std::string>& visited,
                   const std::filesystem::path& file) const;
  void read_events(Time now);
  void compare_files(Time now);
  bool still_changing(Time now);
  std::vector<std::string> collect_changed();

  Mode mode_;
  std::optional<system::FolderEvents> events_;
  std::map<std::string, model::FileStamp> files_;
  std::map<int, Folder> folders_;  // by the number that system::FolderEvents gives them
  std::optional<Time> quiet_at_;
  std::optional<Time> next_poll_;
  std::map<std::string, model::FileStamp> last_stamps_;
};

}  // namespace limber::app
