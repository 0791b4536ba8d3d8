// SceneLoader: a thread that loads other scenes, takes and models on request, and reloads the scene when one of its
// files is saved or a parameter with `rerun` has changed.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/show/file_watch.h"
#include "app/viewer/shown_models.h"
#include "base/system/wake.h"
#include "base/threads/bounded_queue.h"
#include "engine/engine.h"

namespace limber::app {

/// [main], unless noted otherwise
class SceneLoader {
 public:
  /// Must be created before the engine starts; `link` and `engine` must outlive it. `scene`: the file that plays; other
  /// scenes are loaded from its folder only.
  /// `models`, if not null, receives the models that are added, and passes dropped files to add_model(); it must
  /// outlive the loader.
  SceneLoader(engine::EngineLink& link, engine::Engine& engine, const std::string& scene, ShownModels* models = nullptr,
              FileWatch::Mode mode = FileWatch::Mode::events);
  ~SceneLoader() { stop(); }
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  /// Sets a function that is called with the file of another scene, once it plays. Call it before start(). [main]
  void on_scene(std::function<void(const std::string& scene)> changed) { on_scene_ = std::move(changed); }
  /// Starts to watch the files of the scene, which must have run. [main]
  void start();
  /// Adds a model, given by its file or a folder with one model, to the running scene. The thread reports the result to
  /// the log and the panel. [any]
  void add_model(const std::string& path);
  /// Stops the thread; called after the engine has ended. [main]
  void stop();

 private:
  // A request for a scene or take. It is canceled if a panic (for a take, also the end of a take) happens after it
  // arrived, that is if the count exceeds `stops_before`.
  struct SceneRequest {
    Message message;
    CommandOrigin origin;
    std::uint64_t stops_before = 0;  // when it arrived: number of panics; for a take, of panics and ended takes
    friend std::size_t weight_of(const SceneRequest& request) {
      return sizeof request + engine::weight_of(request.message);
    }
  };

  void run(FileWatch& files);
  bool handle(const SceneRequest& request);
  bool reload_cues(std::vector<std::string>& saved);
  bool play_take(const SceneRequest& request);
  bool handle_model(const SceneRequest& request);
  std::vector<std::string> scenes() const;
  std::vector<std::string> takes() const;
  void reject(const SceneRequest& request, const std::string& reason);
  void wait(const FileWatch& files);

  engine::EngineLink& link_;
  engine::Engine& engine_;
  ShownModels* models_;
  std::string folder_;
  std::string takes_folder_;  // the folder of the show's takes
  FileWatch::Mode mode_;
  std::function<void(const std::string&)> on_scene_ = [](const std::string&) {};
  BoundedQueue<SceneRequest> requests_{64, std::size_t{1} << 16};
  system::Wake wake_;
  bool reload_pending_ = false;  // a file was saved while a take played; used by the thread only
  bool cues_pending_ = false;    // the same of the cue file
  std::atomic<bool> stop_{false};
  std::atomic<bool> rerun_{false};
  std::thread thread_;
};

}  // namespace limber::app
