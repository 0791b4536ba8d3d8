// PresetSaver: saves presets on its own thread, so that a tick never waits for the disk. Of several saves in a burst
// only the last one is written.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "engine/presets/file.h"

namespace limber {

class PresetSaver {
 public:
  /// `on_failure` is called with the reason when a save fails. [the saver's thread]
  PresetSaver(PresetFile file, std::function<void(const std::string&)> on_failure)
      : file_(std::move(file)), on_failure_(std::move(on_failure)) {}
  /// Completes the pending save.
  ~PresetSaver();
  PresetSaver(const PresetSaver&) = delete;
  PresetSaver& operator=(const PresetSaver&) = delete;

  /// Reads the file. Call before the first save().
  Result<ParsedPresets> load() { return file_.load(); }
  const std::string& path() const { return file_.path(); }
  /// Requests a save and returns at once. [sim]
  void save(std::shared_ptr<const PresetList> presets);
  /// True if the latest presets passed to save() are on the disk. [any]
  bool saved() const { return saved_.load(); }
  /// Waits until the pending save has succeeded or failed. [any but sim]
  void finish();

 private:
  void run();

  PresetFile file_;  // used only by the thread, once it runs
  std::function<void(const std::string&)> on_failure_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const PresetList> pending_;
  bool writing_ = false;
  std::atomic<bool> saved_{true};
  bool stopping_ = false;
  std::thread thread_;  // started by the first save
};

}  // namespace limber
