// PresetKeeper: writes presets to their file on a thread of its own, so that a tick never waits for a disk. Of several
// saves in a burst the last one is written.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "engine/preset_file.h"

namespace limber {

class PresetKeeper {
 public:
  /// `failed` is told why a save failed. [the keeper's thread]
  PresetKeeper(PresetFile file, std::function<void(const std::string&)> failed)
      : file_(std::move(file)), failed_(std::move(failed)) {}
  /// What was to be saved is saved before it goes.
  ~PresetKeeper();
  PresetKeeper(const PresetKeeper&) = delete;
  PresetKeeper& operator=(const PresetKeeper&) = delete;

  /// Before anything is saved.
  Result<PresetsRead> load() { return file_.load(); }
  const std::string& path() const { return file_.path(); }
  /// Soon it is on the disk. Waits for nothing. [sim]
  void save(std::shared_ptr<const PresetList> presets);
  /// Whether what save() was given last is on the disk. [any]
  bool saved() const { return saved_.load(); }
  /// Returns when all that was to be saved is, or has failed. [any but sim]
  void finish();

 private:
  void run();

  PresetFile file_;  // of the thread, once it runs
  std::function<void(const std::string&)> failed_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const PresetList> wanted_;
  bool writing_ = false;
  std::atomic<bool> saved_{true};
  bool end_ = false;
  std::thread thread_;  // from the first save on
};

}  // namespace limber
