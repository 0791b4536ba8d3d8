// SceneWatch: a thread that reloads the scene when one of its files is saved or a parameter with `rerun` has changed,
// and that loads other scenes and takes on request.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "app/show/file_watch.h"
#include "base/system/wake.h"
#include "base/threads/bounded_queue.h"
#include "engine/engine.h"

namespace limber {

/// [main], unless noted otherwise
class SceneWatch {
 public:
  /// Must be created before the engine starts; `link` and `engine` must outlive it. `scene`: the file that plays; other
  /// scenes are loaded from its folder only.
  SceneWatch(EngineLink& link, Engine& engine, const std::string& scene,
             FileWatch::Mode mode = FileWatch::Mode::events);
  ~SceneWatch() { stop(); }
  SceneWatch(const SceneWatch&) = delete;
  SceneWatch& operator=(const SceneWatch&) = delete;

  /// Starts to watch the files of the scene, which must have run. [main]
  void start();
  /// Stops the thread; called after the engine has ended. [main]
  void stop();

 private:
  void run(FileWatch& files);
  bool handle(const Command& command);
  bool play_take(const Command& command);
  std::vector<std::string> scenes() const;
  std::vector<std::string> takes() const;
  void reject(const Message& request, const CommandOrigin& origin, const std::string& reason);
  void wait(const FileWatch& files);

  EngineLink& link_;
  Engine& engine_;
  std::string folder_;
  std::string takes_folder_;  // the folder of the show's takes
  FileWatch::Mode mode_;
  // requests for scenes and takes; `arrival` holds the panic count (or the count of ended takes) when they arrived
  BoundedQueue<Command> requests_{64, std::size_t{1} << 16};
  system::Wake wake_;
  bool reload_pending_ = false;  // a file was saved while a take played; used by the thread only
  std::atomic<bool> stop_{false};
  std::atomic<bool> rerun_{false};
  std::thread thread_;
};

}  // namespace limber
