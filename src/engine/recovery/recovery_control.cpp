// RecoveryControl: start of a recovery, and the choice of the tick in which values are copied.
#include "engine/recovery/recovery_control.h"

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/plural.h"
#include "base/text.h"

namespace limber::engine {

namespace {
constexpr std::uint32_t kCheapNodeCount = 4096;  // nodes that can be visited in one tick at negligible cost
}

void RecoveryControl::open() {
  const EngineOptions& options = show_.options;
  if (options.recovery.folder.empty() || options.scene.empty()) return;
  saver_ = std::make_unique<RecoverySaver>(show_.writer, options.recovery.folder, options.recovery.interval);
  const Result<std::optional<RecoverableValues>> recoverable = saver_->open(options.scene);
  if (!saver_->owned()) {
    log_warning("{}{}", options.recovery.restore ? "--recover: " : "", RecoverySaver::kOwnedElsewhere);
  } else if (!recoverable) {
    log_error("{}", recoverable.error());
  } else if (!*recoverable) {
    if (options.recovery.restore)
      log_warning("--recover: there is nothing to recover; the last run of this scene exited cleanly");
  } else if (options.recovery.restore) {
    show_.recovered = (*recoverable)->values;
    crash_time_ = (*recoverable)->time_text();
  } else {
    log_warning("{}", (*recoverable)->message());
  }
}

Result<void> RecoveryControl::apply() {
  if (show_.recovered == nullptr) return {};
  const Result<std::string> notice = show_.presets.restore(show_.session->world, show_.recovered);
  if (!notice) return Error{fmt::format("--recover: {}", notice.error())};
  const std::size_t count = show_.recovered->schema->property_count();
  log_info("--recover: {} restored as of {}{}{}", counted(count, "value was", "values were"),
           crash_time_.empty() ? "the start of the take" : crash_time_, notice->empty() ? "" : "; ", *notice);
  if (saver_ != nullptr && !suspended_) saver_->set_recovered();
  return {};
}

void RecoveryControl::begin() {
  if (saver_ != nullptr) saver_->begin();
}

void RecoveryControl::update(const std::shared_ptr<const Preset>& script) {
  if (saver_ == nullptr || suspended_ || !saver_->wants_values()) return;
  const Store& store = show_.session->store;
  const std::string& scene = show_.options.scene;
  if (submitted_version_ == store.persistent_version() && submitted_scene_ == scene) {
    saver_->submit(scene, nullptr, nullptr);
    return;
  }
  const bool cheap = show_.presets.ready(store) || store.view()->slot_count <= kCheapNodeCount;
  if (show_.session->scene == nullptr || (!cheap && !saver_->overdue())) return;
  submitted_version_ = store.persistent_version();
  submitted_scene_ = scene;
  saver_->submit(scene, show_.presets.capture_all(store), script);
}

void RecoveryControl::end() {
  if (saver_ != nullptr) saver_->end();
}

}  // namespace limber::engine
