// PresetFile: the file with the presets of a scene, next to the scene's file. It is replaced atomically. A file that
// could not be parsed completely, or that another program has changed, is backed up first. [one thread]
// PresetSaver: saves the file in the background.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "base/result.h"
#include "engine/background_writer.h"
#include "engine/presets/scene_lock.h"
#include "engine/presets/text.h"
#include "model/file_stamp.h"

namespace limber::engine {

class PresetFile {
 public:
  static constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 28u;  ///< 256 MiB.

  /// Returns the path for a scene: "scripts/arms.presets.json" for "scripts/arms.lua".
  static std::string path_for(const std::string& scene);

  /// Restrictions on writing the file. `show_folder`: folder within which symbolic links are followed; empty: the
  /// folder of the file.
  struct WriteAccess {
    std::string show_folder;
    std::string lock_file;   ///< The file of a SceneLock; empty: none.
    bool keep_lock = false;  ///< Hold the lock from load() on; else only during a save.
  };

  /// Returns the restrictions for a scene's presets. `locks`: folder of the lock files; empty: none.
  static WriteAccess write_access_for(const std::string& scene, const std::string& locks, bool keep_lock);

  explicit PresetFile(std::string path) : PresetFile(std::move(path), WriteAccess()) {}
  PresetFile(std::string path, WriteAccess access)
      : path_(std::move(path)),
        show_folder_(std::move(access.show_folder)),
        lock_(std::move(access.lock_file)),
        keep_lock_(access.keep_lock) {}
  const std::string& path() const { return path_; }

  /// Reads the presets; none if the file doesn't exist. Errors name the file, which is then backed up by the next
  /// save().
  Result<ParsedPresets> load();
  /// Replaces the file atomically: writes a temporary file, syncs it to the disk and renames it. On an error (the text
  /// doesn't name the file) the old file stays. Fails if another program owns the file, or if it is a link that leads
  /// out of the show's folder or to a file that isn't a preset file. `notice`: message about the backup, if one was
  /// made; else empty.
  Result<void> save(const PresetList& presets, std::string& notice);

 private:
  Result<std::string> target() const;
  Result<void> back_up(const std::string& path, std::string& notice) const;
  Result<void> write(const PresetList& presets, std::string& notice);

  std::string path_;
  std::string show_folder_;
  SceneLock lock_;
  bool keep_lock_ = false;
  model::FileStamp last_stamp_;  // stamp when it was last read or written
  bool has_unparsed_ = false;    // it has content that could not be parsed
};

/// Of several saves in a burst only the last one is written.
class PresetSaver : private BackgroundWriter::Task {
 public:
  /// `on_failure` is called with the reason when a save fails. [the writer's thread]
  PresetSaver(BackgroundWriter& writer, PresetFile file, std::function<void(const std::string&)> on_failure);
  /// Completes the pending save.
  ~PresetSaver() override;

  /// Reads the file. Call before the first save().
  Result<ParsedPresets> load() { return file_.load(); }
  /// Requests a save and returns at once. [sim]
  void save(std::shared_ptr<const PresetList> presets);
  /// True if the latest presets passed to save() are on the disk. [any]
  bool saved() const { return saved_.load(); }
  /// Waits until the pending save has succeeded or failed. [any but sim]
  void finish() { writer_.finish(*this); }

 private:
  BackgroundWriter::Clock::time_point run() override;

  BackgroundWriter& writer_;
  PresetFile file_;  // used only by the writer's thread after load()
  std::function<void(const std::string&)> on_failure_;
  std::mutex mutex_;  // never locked while writing
  std::shared_ptr<const PresetList> pending_;
  std::atomic<bool> saved_{true};
};

}  // namespace limber::engine
