// Engine: values that outlive a crash.
#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

namespace {
constexpr std::uint32_t kFewThings = 4096;  // so many are looked through in a tick without being missed
}

// before the scene runs
void Engine::open_recovery() {
  if (options_.recovery.empty() || options_.scene.empty()) return;
  recovery_ = std::make_unique<RecoveryKeeper>(options_.recovery, options_.recovery_every);
  const Result<std::optional<LostValues>> lost = recovery_->open(options_.scene);
  if (!recovery_->owned()) {
    log_warning("{}{}", options_.recover ? "--recover: " : "", RecoveryKeeper::kElsewhere);
  } else if (!lost) {
    log_error("{}", lost.error());
  } else if (!*lost) {
    if (options_.recover) log_warning("--recover: there is nothing to recover; the last run of this scene ended well");
  } else if (options_.recover) {
    recovered_ = (*lost)->values;
    recovered_when_ = (*lost)->when();
  } else {
    log_warning("{}", (*lost)->offer());
  }
}

// what the command line says goes before
Result<void> Engine::bring_back() {
  if (recovered_ == nullptr) return {};
  const Result<std::string> said = presets_.bring_back(stage_->world, recovered_);
  if (!said) return Error{fmt::format("--recover: {}", said.error())};
  const std::size_t count = recovered_->shape->row_count();
  log_info("--recover: {} value{} at {}{}{}", count, count == 1 ? " is back as it was" : "s are back as they were",
           recovered_when_.empty() ? "the take's beginning" : recovered_when_, said->empty() ? "" : "; ", *said);
  if (recovery_ != nullptr && !replays()) recovery_->brought_back();
  return {};
}

void Engine::give_recovery() {
  const Store& store = stage_->store;
  if (given_version_ == store.kept_version() && given_scene_ == options_.scene) {
    recovery_->give(options_.scene, nullptr, nullptr);
    return;
  }
  const bool cheap = presets_.ready(store) || store.view()->slot_count <= kFewThings;
  if (stage_->scene == nullptr || (!cheap && !recovery_->urges())) return;
  given_version_ = store.kept_version();
  given_scene_ = options_.scene;
  recovery_->give(options_.scene, presets_.everything(store), reload_.script());
}

void Engine::end_recovery() {
  if (recovery_ != nullptr) recovery_->end();
}

}  // namespace limber
