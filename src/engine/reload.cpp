// From an order to a draft to the show.
#include "engine/reload.h"

#include <bit>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "engine/preset_taker.h"
#include "script/earlier_runs.h"

namespace limber {

namespace {

std::string counted(std::uint64_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

Reload::Reload(std::string file, ScriptHost& host, PerformerHand& hand)
    : file_(std::move(file)), host_(host), hand_(hand) {}

void Reload::begin(const Stage& stage, const SceneOptions& options, const std::string& file,
                   std::vector<SourceFile> tried) {
  file_ = file;
  options_ = options;
  description_ = std::make_shared<const Description>(describe(stage.world));
  things_ = things_of(stage.world);
  script_ = PresetTaker::take_script(stage.store);
  sources_ = stage.scene == nullptr ? nullptr : stage.scene->sources();
  ran_with_.clear();
  if (stage.scene != nullptr) stage.scene->rerun_values(ran_with_);
  keep_files(std::move(tried));
  if (stage.scene != nullptr) say_mended();
}

DraftOrder Reload::order(const Stage& stage, bool again) {
  DraftOrder order{file_, options_, {}, description_};
  if (stage.scene == nullptr) return order;
  order.inputs = stage.scene->inputs();
  if (again) order.inputs.sources = sources_;
  stage.scene->rerun_values(ran_with_);
  return order;
}

bool Reload::take_rerun(const Stage& stage) {
  if (stage.scene == nullptr) return false;
  stage.scene->rerun_values(values_);
  if (values_ == ran_with_) return false;
  ran_with_ = values_;
  return true;
}

Reload::End Reload::take(Draft& draft, Stage& stage) {
  if (draft.order().before != description_) return End::outdated;
  const bool from_disk = draft.order().inputs.sources == nullptr;
  if (from_disk) log_forget_sources();
  if (!draft.ran()) {
    keep_files(draft.files());
    host_.script_error(draft.fault().file, draft.fault().line, draft.ran().error());
    return End::failed;
  }
  Store& store = stage.store;
  const auto set_by_scene = [&](NodeId id, const Row& row) {
    if (hand_.size() > 0) hand_.give_back(fmt::format("{}/{}", store.path(id), row.name));
  };
  if (stage.scene != nullptr) stage.scene->note_things();
  apply({stage.world, draft.world(), *description_, *draft.description(), draft.difference(), set_by_scene}, things_);
  const auto live_id = [&](NodeId id) { return draft.live_id(id, stage.world, things_.shapes, things_.bodies); };
  std::unique_ptr<Scene>& scene = draft.scene();
  scene->rerun_values(ran_with_);
  std::uint64_t defaults = scene->become_live(stage.world, live_id, stage.scene.get());
  for (const NodeId params = scene->params(); defaults != 0; defaults &= defaults - 1)
    set_by_scene(params, store.table(params).row(static_cast<std::uint32_t>(std::countr_zero(defaults))));
  std::swap(stage.scene, scene);
  description_ = draft.description();
  script_ = draft.script();
  sources_ = stage.scene->sources();
  if (from_disk) {
    keep_files({});
    stage.world.panic().end();  // the mended scene plays
    say_mended();
    log_info("{} was read again", stage.scene->fault().file);
  }
  say_kept(stage.scene->kept(), from_disk);
  return End::applied;
}

// another value of a parameter with `rerun` may come many times a second, so that alone tells of a loss only
void Reload::say_kept(const KeptTimers& kept, bool from_disk) {
  if (kept.ended > 0) {
    log_warning("{} scheduled by the oldest run ended: a scene keeps the timers of {} runs before the last save",
                counted(kept.ended, "timer"), EarlierRuns::kMax);
  }
  if (!from_disk) return;
  if (kept.timers > 0) {
    log_info("{} set by callbacks before the save {} on{}; a reset ends {}", counted(kept.timers, "timer"),
             kept.timers == 1 ? "goes" : "go", kept.repeating > 0 ? fmt::format(" ({} repeating)", kept.repeating) : "",
             kept.timers == 1 ? "it" : "them");
  }
  if (kept.handlers > 0) {
    log_warning(
        "{} registered in callbacks ended with the save (osc:on, sim:on_step, sim:on_contact); register them at "
        "the top level",
        counted(kept.handlers, "handler"));
  }
}

void Reload::say_mended() {
  for (const std::string& file : std::exchange(faulty_, {})) host_.script_error(file, 0, "");
}

void Reload::keep_files(std::vector<SourceFile> files) {
  if (sources_ != nullptr) {
    const std::vector<SourceFile> good = sources_->files();
    files.insert(files.end(), good.begin(), good.end());
  }
  if (files.empty() && !file_.empty()) files.push_back({file_, {}});
  const std::scoped_lock lock(files_mutex_);
  files_ = std::move(files);
}

std::vector<SourceFile> Reload::files() const {
  const std::scoped_lock lock(files_mutex_);
  return files_;
}

}  // namespace limber
