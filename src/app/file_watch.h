// FileWatch: which of some files have changed, told once they have been quiet for a while, whatever way an editor
// saves. It looks at the folders on the way to a file, not at the file, since saving may put another file in place, and
// an update another folder or link. [one thread]
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
#include "script/sources.h"

namespace limber {

class FileWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// Told by the kernel; or looked for four times a second, as on file systems whose changes the kernel does not hear
  /// of. Events turn into polling by themselves where it must be.
  enum class Way : std::uint8_t { events, polling };

  static constexpr auto kQuiet = std::chrono::milliseconds(50);
  static constexpr auto kLook = std::chrono::milliseconds(250);
  /// A file that was made and is not closed yet may be half written.
  static constexpr auto kOpenFile = std::chrono::milliseconds(500);

  explicit FileWatch(Way way = Way::events);
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// The files that count from now on, whether they exist or not. One that does not hold what was read of it counts as
  /// changed.
  void watch(const std::vector<SourceFile>& files, Time now);
  /// Becomes readable when something has happened; -1: nothing will.
  int fd() const { return events_ ? events_->fd() : -1; }
  Way way() const { return way_; }
  /// When poll() is to be called even if nothing happens.
  std::optional<Time> due() const;
  /// The files that hold something else than when they were last told, once all is quiet; a file that is gone is not
  /// told until it is back. Never waits.
  std::vector<std::string> poll(Time now);

 private:
  struct Folder {
    std::string path;
    std::set<std::string> names;  // what counts in it
  };

  void arm();
  void want(std::map<std::string, std::set<std::string>>& folders, std::set<std::string>& seen,
            const std::filesystem::path& file) const;
  void read_events(Time now);
  void look(Time now);
  bool still_moving(Time now);
  std::vector<std::string> take_changed();

  Way way_;
  std::optional<system::FolderEvents> events_;
  std::map<std::string, FileStamp> files_;
  std::map<int, Folder> folders_;  // by number
  std::optional<Time> settle_at_;
  std::optional<Time> next_look_;
  std::map<std::string, FileStamp> seen_moving_;
};

}  // namespace limber
