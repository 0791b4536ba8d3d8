// Engine: what the command line and scripts ask of presets.
#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "engine/engine.h"

namespace limber {

namespace {
constexpr std::size_t kMostWishes = 256;  // of scripts, in a tick
}

Presets::Book Engine::read_presets(const std::string& scene) {
  PresetFile::Owner owner = PresetFile::owner_of(scene, options_.locks, !options_.recovery.empty());
  // called by the thread that writes the file: not through push_out, which reads what the simulation thread changes
  return Presets::read(scene, std::move(owner), [this](const std::string& why) {
    link_.push_out({Outgoing::To::error, {}, error_message("/preset/store", why)});
  });
}

// what the command line has said
Result<void> Engine::first_hand() {
  if (Result<void> back = bring_back(); !back) return back;
  if (!options_.preset.empty()) {
    const Outcome outcome = stage_->dispatch.execute({"/preset/recall", {Arg::of(options_.preset)}});
    if (outcome.kind != Outcome::Kind::applied) return Error{fmt::format("--preset: {}", outcome.error)};
    if (!outcome.said.empty()) say_left_out(outcome.said);
  }
  for (const Message& message : options_.sets) {
    const Outcome outcome = stage_->dispatch.execute(message);
    if (outcome.kind == Outcome::Kind::answered) {
      return Error{
          fmt::format("--set {}: this is a question, no value; set a path, such as /physics/sim/gravity=0,0,-1.6",
                      message.address)};
    }
    if (outcome.kind != Outcome::Kind::applied)
      return Error{fmt::format("--set {}: {}", printable(message.address), outcome.error)};
    if (outcome.clamped != nullptr) say_clamped(message, *outcome.clamped);
    hand_.remember(message);
  }
  return {};
}

// what scripts have asked of presets, in the order in which they did
void Engine::carry_out_wishes() {
  if (wishes_.empty()) return;
  Hands hands(stage_->world, presets_, edits_, notes_);
  hands.begin({Hand::script});
  for (std::size_t i = 0; i < wishes_.size(); i++) {
    const Outcome outcome = stage_->dispatch.execute(wishes_[i]);
    if (again_) continue;
    if (outcome.kind == Outcome::Kind::refused) {
      faults_++;
      log_error("{} of a script: {}", wishes_[i].address, outcome.error);
    }
    if (!outcome.said.empty()) say_left_out(outcome.said);
  }
  wishes_.clear();
}

Result<void> Engine::check_preset(const Message& wish, std::span<const Message> before) {
  // those of calls before that wait still
  std::vector<Message> all = wishes_;
  all.insert(all.end(), before.begin(), before.end());
  if (all.size() >= kMostWishes) return Error{fmt::format("more than {} wishes of presets in a tick", kMostWishes)};
  return presets_.check(wish, all);
}

void Engine::ask_preset(Message&& wish) { wishes_.push_back(std::move(wish)); }

std::vector<std::string> Engine::preset_names() {
  std::vector<std::string> names;
  for (const auto& preset : presets_.list()) names.push_back(preset->name);
  return names;
}

}  // namespace limber
