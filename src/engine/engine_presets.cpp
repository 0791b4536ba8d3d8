// Engine: preset commands from the command line and from scripts.
#include <fmt/format.h>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

namespace {
constexpr std::size_t kMaxPresetCommands = 256;  // preset commands of scripts per tick
}

Presets::Bank Engine::read_presets(const std::string& scene) {
  PresetFile::WriteAccess access =
      PresetFile::write_access_for(scene, options_.lock_folder, !options_.recovery_folder.empty());
  // called by the thread that writes the file: not through push_out, which reads data of the simulation thread
  return Presets::read(scene, std::move(access), [this](const std::string& why) {
    link_.push_out({Outgoing::Destination::error, {}, error_message("/preset/store", why)});
  });
}

// Applies the values of the command line: --recover, --preset, --set.
Result<void> Engine::apply_initial_overrides() {
  if (Result<void> recovered = apply_recovered(); !recovered) return recovered;
  if (!options_.preset.empty()) {
    const Outcome outcome = session_->dispatcher.execute({"/preset/recall", {Arg::of(options_.preset)}});
    if (outcome.kind != Outcome::Kind::applied) return Error{fmt::format("--preset: {}", outcome.error)};
    if (!outcome.warning.empty()) report_warning(outcome.warning);
  }
  for (const Message& message : options_.sets) {
    const Outcome outcome = session_->dispatcher.execute(message);
    if (outcome.kind == Outcome::Kind::answered) {
      return Error{
          fmt::format("--set {}: this is a query, not a value; set a path, such as /physics/sim/gravity=0,0,-1.6",
                      message.address)};
    }
    if (outcome.kind != Outcome::Kind::applied)
      return Error{fmt::format("--set {}: {}", printable(message.address), outcome.error)};
    if (outcome.clamped != nullptr) report_clamped(message, *outcome.clamped);
    overrides_.add(message);
  }
  return {};
}

// Executes the preset commands of scripts, in order.
void Engine::execute_preset_requests() {
  if (preset_requests_.empty()) return;
  EditScope edit_scope(session_->world, presets_, undo_stack_, change_recorder_);
  edit_scope.begin({CommandSource::script});
  for (std::size_t i = 0; i < preset_requests_.size(); i++) {
    const Outcome outcome = session_->dispatcher.execute(preset_requests_[i]);
    if (resimulating_) continue;
    if (outcome.kind == Outcome::Kind::rejected) {
      faults_++;
      log_error("{} of a script: {}", preset_requests_[i].address, outcome.error);
    }
    if (!outcome.warning.empty()) report_warning(outcome.warning);
  }
  preset_requests_.clear();
}

Result<void> Engine::check_preset(const Message& request, std::span<const Message> earlier) {
  // commands of earlier calls are still pending
  std::vector<Message> all = preset_requests_;
  all.insert(all.end(), earlier.begin(), earlier.end());
  if (all.size() >= kMaxPresetCommands)
    return Error{fmt::format("more than {} preset commands in a tick", kMaxPresetCommands)};
  return presets_.check(request, all);
}

void Engine::request_preset(Message&& request) { preset_requests_.push_back(std::move(request)); }

std::vector<std::string> Engine::preset_names() {
  std::vector<std::string> names;
  for (const auto& preset : presets_.list()) names.push_back(preset->name);
  return names;
}

}  // namespace limber
