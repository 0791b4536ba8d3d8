// RecoverySaver: saves the property values every few seconds for recovery after a crash, in the background; a tick only
// copies the values.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "engine/background_writer.h"
#include "engine/recovery/recovery_file.h"

namespace limber::engine {

class RecoverySaver : private BackgroundWriter::Task {
 public:
  static constexpr auto kInterval = std::chrono::seconds(5);
  static constexpr const char* kOwnedElsewhere =
      "another program plays this scene and owns its presets and recovery file; this one saves neither until the "
      "other has ended; takes can be recorded with --record FILE";

  RecoverySaver(BackgroundWriter& writer, std::string folder, std::chrono::milliseconds interval = kInterval)
      : writer_(writer), folder_(std::move(folder)), interval_(interval) {}
  /// Keeps the saved file, as after a crash.
  ~RecoverySaver() override { writer_.remove(*this); }

  /// Opens the recovery file of a scene and returns the values left by a crashed run, if there are any. Error: the file
  /// is damaged, or nothing can be saved. Before begin().
  Result<std::optional<RecoverableValues>> open(const std::string& scene);
  /// False if another program plays the scene and owns the file; this one takes over when the other has ended. [any,
  /// after open()]
  bool owned() const { return !owned_elsewhere_; }
  /// Notes that the values from open() were restored, so that end() removes them. Before begin().
  void set_recovered() { recovered_ = true; }
  /// Starts to request values periodically.
  void begin();

  /// True if values are due. A relaxed atomic load. [sim]
  bool wants_values() const { return wants_values_.load(std::memory_order_relaxed); }
  /// True if values are overdue: submit() should be called even if copying them is expensive. [sim]
  bool overdue() const { return overdue_.load(std::memory_order_relaxed); }
  /// Passes the values to be saved: `now`, all current properties; `script`, all properties as the last run of the
  /// scene left them. Null: unchanged since the last call. [sim]
  void submit(const std::string& scene, std::shared_ptr<const Preset> now, std::shared_ptr<const Preset> script);

  /// Ends the session cleanly: removes the saved values. [any but sim]
  void end();

 private:
  struct Values {
    std::string scene;
    std::shared_ptr<const Preset> now, script;
  };
  BackgroundWriter::Clock::time_point run() override;
  void write(const Values& submitted);
  void switch_scene(const std::string& scene);
  void try_take_over();

  BackgroundWriter& writer_;
  std::string folder_;
  std::chrono::milliseconds interval_;
  // used only by the writer's thread after begin():
  BackgroundWriter::Clock::time_point next_;  // time at which values are requested again
  int unanswered_requests_ = 0;
  std::unique_ptr<RecoveryFile> file_;  // null: not available
  std::string scene_;                   // as passed to open()
  std::shared_ptr<const Preset> saved_;
  bool recovered_ = false;
  std::atomic<bool> owned_elsewhere_{false};  // another program owns the file
  std::optional<Values> unsaved_;             // latest values while another program owns the file
  bool failure_reported_ = false;             // a failure to save was reported
  std::atomic<bool> wants_values_{false};
  std::atomic<bool> overdue_{false};
  std::mutex mutex_;  // never locked while writing
  std::optional<Values> submitted_;
};

}  // namespace limber::engine
