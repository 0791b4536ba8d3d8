// Engine: crash recovery of property values.
#include <fmt/format.h>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

namespace {
constexpr std::uint32_t kCheapNodeCount = 4096;  // nodes that can be visited in one tick at negligible cost
}

// Opens the recovery file, before the scene runs. Offers or loads values of a run that crashed.
void Engine::open_recovery() {
  if (options_.recovery_folder.empty() || options_.scene.empty()) return;
  recovery_ = std::make_unique<RecoverySaver>(options_.recovery_folder, options_.recovery_interval);
  const Result<std::optional<RecoverableValues>> recoverable = recovery_->open(options_.scene);
  if (!recovery_->owned()) {
    log_warning("{}{}", options_.recover ? "--recover: " : "", RecoverySaver::kOwnedElsewhere);
  } else if (!recoverable) {
    log_error("{}", recoverable.error());
  } else if (!*recoverable) {
    if (options_.recover)
      log_warning("--recover: there is nothing to recover; the last run of this scene exited cleanly");
  } else if (options_.recover) {
    recovered_ = (*recoverable)->values;
    recovered_time_ = (*recoverable)->time_text();
  } else {
    log_warning("{}", (*recoverable)->message());
  }
}

// Applies recovered values. Called before the values of --preset and --set, which take precedence.
Result<void> Engine::apply_recovered() {
  if (recovered_ == nullptr) return {};
  const Result<std::string> notice = presets_.restore(session_->world, recovered_);
  if (!notice) return Error{fmt::format("--recover: {}", notice.error())};
  const std::size_t count = recovered_->schema->property_count();
  log_info("--recover: {} value{} as of {}{}{}", count, count == 1 ? " was restored" : "s were restored",
           recovered_time_.empty() ? "the start of the take" : recovered_time_, notice->empty() ? "" : "; ", *notice);
  if (recovery_ != nullptr && !is_replaying()) recovery_->set_recovered();
  return {};
}

void Engine::update_recovery() {
  const Store& store = session_->store;
  if (recovery_version_ == store.persistent_version() && recovery_scene_ == options_.scene) {
    recovery_->submit(options_.scene, nullptr, nullptr);
    return;
  }
  const bool cheap = presets_.ready(store) || store.view()->slot_count <= kCheapNodeCount;
  if (session_->scene == nullptr || (!cheap && !recovery_->overdue())) return;
  recovery_version_ = store.persistent_version();
  recovery_scene_ = options_.scene;
  recovery_->submit(options_.scene, presets_.capture_all(store), reloader_.script_preset());
}

void Engine::end_recovery() {
  if (recovery_ != nullptr) recovery_->end();
}

}  // namespace limber
