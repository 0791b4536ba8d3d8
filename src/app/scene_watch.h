// SceneWatch: the thread that runs a scene beside the show, when one of its files was saved, a parameter with `rerun`
// has changed, or another scene of the folder is asked for.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "app/file_watch.h"
#include "base/inbox.h"
#include "base/system/wake.h"
#include "engine/engine.h"

namespace limber {

class SceneWatch {
 public:
  /// Made before the engine starts; `link` and `engine` outlive it. `scene`: the file that plays; its folder is the
  /// only one that scenes are taken from.
  SceneWatch(EngineLink& link, Engine& engine, const std::string& scene, FileWatch::Way way = FileWatch::Way::events);
  ~SceneWatch() { stop(); }
  SceneWatch(const SceneWatch&) = delete;
  SceneWatch& operator=(const SceneWatch&) = delete;

  /// Once the scene has run: from here on its files are watched. [main]
  void start();
  /// After the engine has ended. [main]
  void stop();

 private:
  void run(FileWatch& files);
  bool serve(const Command& command);
  bool play_take(const Command& command);
  std::vector<std::string> scenes() const;
  std::vector<std::string> takes() const;
  void refuse(const Message& wish, const Origin& origin, const std::string& why);
  void sleep(const FileWatch& files);

  EngineLink& link_;
  Engine& engine_;
  std::string folder_;
  std::string takes_;  // the folder of the show's
  FileWatch::Way way_;
  // messages about scenes; `arrival`: the panics, or ends of takes, when they came
  Inbox<Command> wishes_{64, std::size_t{1} << 16};
  system::Wake wake_;
  bool late_ = false;  // something was saved while a take played; of the thread
  std::atomic<bool> stop_{false};
  std::atomic<bool> rerun_{false};
  std::thread thread_;
};

}  // namespace limber
