// RecoveryKeeper: has the show's values on the disk every few seconds, on a thread of its own; a tick only copies them.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "engine/recovery_file.h"

namespace limber {

class RecoveryKeeper {
 public:
  static constexpr auto kEvery = std::chrono::seconds(5);
  static constexpr const char* kElsewhere =
      "another program plays this scene and owns its presets and recovery file; this one writes neither until that has "
      "ended; takes can be recorded with --record FILE";

  explicit RecoveryKeeper(std::string folder, std::chrono::milliseconds every = kEvery);
  /// As a crash would: what is saved stays.
  ~RecoveryKeeper();
  RecoveryKeeper(const RecoveryKeeper&) = delete;
  RecoveryKeeper& operator=(const RecoveryKeeper&) = delete;

  /// Takes the scene's file: what a run of it has left that did not end well. An error: what is damaged, or why
  /// nothing can be kept. Before begin().
  Result<std::optional<LostValues>> open(const std::string& scene);
  /// False: another program plays the scene and owns the file; this one takes it over when that has ended. [any, after
  /// open()]
  bool owned() const { return !elsewhere_; }
  /// What was lost is in the show's values from here on. Before begin().
  void brought_back() { brought_back_ = true; }
  /// From here on values are asked for.
  void begin();

  /// Whether it is time to give it values. Costs nothing. [sim]
  bool asks() const { return asks_.load(std::memory_order_relaxed); }
  /// It has asked for long: values that are dear are wanted, too. [sim]
  bool urges() const { return urges_.load(std::memory_order_relaxed); }
  /// Every property as it is, and as the scene's run described it; null: as it was given last. [sim]
  void give(const std::string& scene, std::shared_ptr<const Preset> now, std::shared_ptr<const Preset> script);

  /// The show has ended well: nothing needs to be brought back. [any but sim]
  void end();

 private:
  struct Given {
    std::string scene;
    std::shared_ptr<const Preset> now, script;
  };
  void run();
  void write(const Given& given);
  void follow(const std::string& scene);
  void take_over();
  void stop();

  std::string folder_;
  std::chrono::milliseconds every_;
  std::unique_ptr<RecoveryFile> file_;  // of the thread, once it runs; null: none can be had
  std::string scene_;                   // as it was given
  std::shared_ptr<const Preset> saved_;
  bool brought_back_ = false;
  std::atomic<bool> elsewhere_{false};  // another program has the file
  std::optional<Given> unsaved_;        // given last, while it had
  bool told_ = false;                   // that saving fails
  std::atomic<bool> asks_{false};
  std::atomic<bool> urges_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Given> given_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace limber
