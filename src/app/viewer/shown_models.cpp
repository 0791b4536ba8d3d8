// A mutex protects the list of added models and the receiver.
#include "app/viewer/shown_models.h"

#include <filesystem>

#include "base/log/log.h"

namespace limber::app {

std::string ShownModels::proposed_file() const {
  return model_ ? std::filesystem::path(model_->model).stem().string() + ".lua" : "";
}

Result<void> ShownModels::save(const std::string& file, bool overwrite) const {
  ModelScene scene = *model_;
  {
    const std::scoped_lock lock(mutex_);
    scene.added = added_;
  }
  return save_model_scene(scene, file, overwrite);
}

void ShownModels::set_receiver(std::function<void(const std::string&)> receiver) {
  const std::scoped_lock lock(mutex_);
  receiver_ = std::move(receiver);
}

void ShownModels::drop(const std::string& path) const {
  const std::scoped_lock lock(mutex_);
  if (receiver_) return receiver_(path);
  log_error("a replay accepts no models: it contains all input");
}

void ShownModels::note_added(const engine::AddedModel& model) {
  const std::scoped_lock lock(mutex_);
  added_.push_back(model);
}

}  // namespace limber::app
