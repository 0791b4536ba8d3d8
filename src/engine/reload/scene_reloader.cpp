// SceneReloader: requests, and applying candidates.
#include "engine/reload/scene_reloader.h"

#include <bit>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/plural.h"
#include "engine/presets/capturer.h"
#include "script/scene/earlier_runs.h"

namespace limber::engine {

SceneReloader::SceneReloader(std::string file, script::ScriptHost& host, Overrides& overrides)
    : file_(std::move(file)), host_(host), overrides_(overrides) {}

void SceneReloader::capture(const Session& session, const script::SceneOptions& options, const std::string& file,
                            std::vector<script::SourceFile> failed_files) {
  file_ = file;
  options_ = options;
  spec_ = std::make_shared<const SceneSpec>(describe(session.world));
  objects_ = live_objects_of(session.world);
  script_preset_ = PresetCapturer::capture_script(session.store);
  sources_ = session.scene == nullptr ? nullptr : session.scene->sources();
  rerun_values_.clear();
  if (session.scene != nullptr) session.scene->rerun_values(rerun_values_);
  set_files(std::move(failed_files));
  if (session.scene != nullptr) report_fixed();
}

ReloadRequest SceneReloader::make_request(const Session& session, bool reuse_files) {
  ReloadRequest request{file_, options_, {}, spec_};
  if (session.scene == nullptr) return request;
  request.inputs = session.scene->inputs();
  if (reuse_files) request.inputs.sources = sources_;
  session.scene->rerun_values(rerun_values_);
  return request;
}

bool SceneReloader::consume_rerun(const Session& session) {
  if (session.scene == nullptr) return false;
  session.scene->rerun_values(scratch_);
  if (scratch_ == rerun_values_) return false;
  rerun_values_ = scratch_;
  return true;
}

SceneReloader::ApplyResult SceneReloader::apply_candidate(ReloadCandidate& candidate, Session& session) {
  if (candidate.request().base_spec != spec_) return ApplyResult::outdated;
  const bool from_disk = candidate.request().inputs.sources == nullptr;
  if (from_disk) log_forget_sources();
  if (!candidate.result()) {
    set_files(candidate.files());
    host_.script_error(candidate.fault().file, candidate.fault().line, candidate.result().error());
    return ApplyResult::failed;
  }
  Store& store = session.store;
  const auto set_by_scene = [&](NodeId id, const Property& property) {
    if (overrides_.size() > 0) overrides_.release(fmt::format("{}/{}", store.path(id), property.name));
  };
  if (session.scene != nullptr) session.scene->capture_handles();
  apply({session.world, candidate.world(), *spec_, *candidate.spec(), candidate.diff(), set_by_scene}, objects_);
  const auto live_id = [&](NodeId id) { return counterpart(candidate.world().store(), id, store); };
  std::unique_ptr<script::Scene>& scene = candidate.scene();
  scene->rerun_values(rerun_values_);
  std::uint64_t default_mask = scene->become_live(session.world, live_id, session.scene.get());
  for (const NodeId params = scene->params(); default_mask != 0; default_mask &= default_mask - 1)
    set_by_scene(params, store.table(params).property(static_cast<std::uint32_t>(std::countr_zero(default_mask))));
  std::swap(session.scene, scene);
  spec_ = candidate.spec();
  script_preset_ = candidate.script_preset();
  sources_ = session.scene->sources();
  if (from_disk) {
    set_files({});
    session.world.panic().end();  // a saved file ends a panic
    report_fixed();
    log_info("{}: reloaded", session.scene->fault().file);
  }
  report_timers(session.scene->carried_timers(), from_disk);
  return ApplyResult::applied;
}

// A parameter with `rerun` may change many times a second, so such runs log losses only.
void SceneReloader::report_timers(const script::CarriedTimers& timers, bool from_disk) {
  if (timers.ended > 0) {
    log_warning("{} scheduled by the oldest run ended: a scene keeps the timers of {} runs before the last save",
                counted(timers.ended, "timer"), script::EarlierRuns::kMaxRuns);
  }
  if (!from_disk) return;
  if (timers.timers > 0) {
    log_info("{} set by callbacks before the save {}{}; a reset ends {}", counted(timers.timers, "timer"),
             plural(timers.timers, "continues", "continue"),
             timers.repeating > 0 ? fmt::format(" ({} repeating)", timers.repeating) : "",
             plural(timers.timers, "it", "them"));
  }
  if (timers.handlers > 0) {
    log_warning(
        "{} registered in callbacks ended with the save (osc:on, sim:on_step, sim:on_contact); register them at "
        "the top level",
        counted(timers.handlers, "handler"));
  }
}

std::vector<std::string> SceneReloader::body_names() const {
  std::vector<std::string> names;
  for (const BodyDescription& body : spec_->bodies) names.push_back(body.name);
  return names;
}

void SceneReloader::report_fixed() {
  for (const std::string& file : std::exchange(files_with_errors_, {})) host_.script_error(file, 0, "");
}

void SceneReloader::set_files(std::vector<script::SourceFile> files) {
  if (sources_ != nullptr) {
    const std::vector<script::SourceFile> files_of_last_run = sources_->files();
    files.insert(files.end(), files_of_last_run.begin(), files_of_last_run.end());
  }
  if (files.empty() && !file_.empty()) files.push_back({file_, {}});
  const std::scoped_lock lock(files_mutex_);
  files_ = std::move(files);
}

std::vector<script::SourceFile> SceneReloader::files() const {
  const std::scoped_lock lock(files_mutex_);
  return files_;
}

}  // namespace limber::engine
