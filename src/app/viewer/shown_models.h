// ShownModels: the models of the running show, for requests of the window: saving them as a scene, and adding files
// that are dropped on the window. Its functions may be called from any thread.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/viewer/model_scene.h"

namespace limber::app {

class ShownModels {
 public:
  /// `model`: the model that the show plays; none for a scene that was written by a person. `package_paths`: folders
  /// for package:// of models that are added.
  ShownModels(std::optional<ModelScene> model, std::vector<std::string> package_paths)
      : model_(std::move(model)), package_paths_(std::move(package_paths)) {}

  const std::vector<std::string>& package_paths() const { return package_paths_; }
  /// True if the show plays a model, so that it can be saved as a scene.
  bool can_save() const { return model_.has_value(); }
  /// The name that is proposed for the file of the scene.
  std::string proposed_file() const;
  /// Writes the scene, with the models that were added. Requires can_save().
  Result<void> save(const std::string& file, bool overwrite) const;

  /// Sets the receiver of dropped files, which is called on the thread that drops them; none while `receiver` is empty.
  void set_receiver(std::function<void(const std::string&)> receiver);
  /// Passes on a file that was dropped on the window; logs an error without a receiver.
  void drop(const std::string& path) const;
  /// Notes a model that was added to the scene.
  void note_added(const engine::AddedModel& model);

 private:
  const std::optional<ModelScene> model_;
  const std::vector<std::string> package_paths_;
  mutable std::mutex mutex_;
  std::vector<engine::AddedModel> added_;
  std::function<void(const std::string&)> receiver_;
};

}  // namespace limber::app
