// SceneWatch: the thread that runs the scene beside the show, when one of its files was saved or a parameter with
// `rerun` has changed.
#pragma once

#include <atomic>
#include <thread>

#include "app/file_watch.h"
#include "engine/engine.h"

namespace limber {

class SceneWatch {
 public:
  /// Made before the engine starts; `link` and `engine` outlive it.
  SceneWatch(EngineLink& link, Engine& engine, FileWatch::Way way = FileWatch::Way::events);
  ~SceneWatch() { stop(); }
  SceneWatch(const SceneWatch&) = delete;
  SceneWatch& operator=(const SceneWatch&) = delete;

  /// Once the scene has run: from here on its files are watched. [main]
  void start();
  /// After the engine has ended. [main]
  void stop();

 private:
  void run();
  void sleep(const FileWatch& files) const;
  void wake() const;

  EngineLink& link_;
  Engine& engine_;
  FileWatch::Way way_;
  int wake_ = -1;
  std::atomic<bool> stop_{false};
  std::atomic<bool> rerun_{false};
  std::thread thread_;
};

}  // namespace limber
