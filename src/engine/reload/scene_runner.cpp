// SceneRunner: start, reset, reload and change of the scene.
#include "engine/reload/scene_runner.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/reload/reload_candidate.h"
#include "sim/visuals/framing.h"
#include "sim/visuals/visuals.h"

namespace limber::engine {

SceneRunner::Run SceneRunner::begin_run(TakeSceneRun::Kind kind, bool reuse_files, const std::string& scene) {
  Run run;
  run.index = recording_.begin_run({kind, false, reuse_files, 0, scene});
  run.files = show_.input->begin_run(kind);
  if (show_.options.scene_text && run.files.sources == nullptr)
    run.files.sources = script::Sources::of_text(show_.options.scene, *show_.options.scene_text);
  return run;
}

// Frames the bodies, and captures the result of a run, for reloads and for the preset "script".
void SceneRunner::capture_run(Session& session, const script::SceneOptions& options, const std::string& file,
                              std::vector<script::SourceFile> failed_files) {
  if (show_.rules.frames_scenes) sim::frame_scene(session.world);
  reloader_.capture(session, options, file, std::move(failed_files));
  show_.presets.set_script_preset(reloader_.script_preset());
}

Result<void> SceneRunner::start() {
  const Run run = begin_run(TakeSceneRun::Kind::start);
  const script::SceneOptions options = show_.scene_options();
  script::SceneOptions run_options = options;
  run_options.sources = run.files.sources;
  if (run.files.fails) return Error{"the scene failed when the take was recorded, too"};
  std::unique_ptr<Session>& session = show_.session;
  const std::string& file = show_.options.scene;
  if (Result<void> result = session->run(file, host_, run_options); !result) {
    std::vector<script::SourceFile> tried_files = session->scene->sources()->files();
    session = show_.new_session();
    capture_run(*session, options, file, std::move(tried_files));
    return result;
  }
  if (session->scene != nullptr) session->scene->set_call_log(show_.call_log);
  recording_.run_succeeded(run.index, *session, show_.presets.list(), show_.presets.file());
  capture_run(*session, options, file);
  if (show_.options.scene_options.seed) {
    const auto seed = static_cast<double>(*show_.options.scene_options.seed);
    (void)session->store.set(session->world.id(), "seed", {&seed, 1});  // can't fail: any 53-bit seed is in range
  }
  show_.scene_seed = session->world.seed();
  if (Result<void> set = apply_initial_overrides(); !set) return set;
  begin_show();
  return {};
}

// Explains the pace of a scene with large time steps, which is not that of ofxDabPhysics: it stepped every 10 ms of the
// clock, whatever the time step.
void SceneRunner::explain_pace() const {
  constexpr double kStepOfOfxDabPhysics = 0.01;  // s of the clock
  constexpr double kLargeStep = 0.05;            // s
  const Session& session = *show_.session;
  const double timestep = session.world.timestep();
  const double speed = session.store.values(session.world.id(), sim::World::table().at("speed"))[0];
  if (timestep < kLargeStep || speed != 1 || !show_.options.in_real_time()) return;
  show_.output().warn_once(
      fmt::format("sim.timestep is {0} s, so this scene makes {1} ticks per second and plays in real time. "
                  "ofxDabPhysics plays it {2} times as fast: set sim.speed = {2} for that pace",
                  number_text(timestep), number_text(std::round(10 / timestep) / 10),
                  number_text(timestep / kStepOfOfxDabPhysics)));
}

// The initial overrides may require another run of the scene (parameters with `rerun`), before its on_start.
void SceneRunner::begin_show() {
  if (reloader_.consume_rerun(*show_.session)) run_now(TakeSceneRun::Kind::rerun, true);
  show_.session->world.flush();
  if (show_.session->scene != nullptr) show_.session->scene->start();
  show_.presets.finish_planning(show_.session->world);
  explain_pace();
}

bool SceneRunner::reset() {
  show_.pacer.excuse_stall();
  const Run run = begin_run(TakeSceneRun::Kind::reset);
  auto fresh = show_.new_session();
  script::SceneOptions options = show_.scene_options();
  const sim::World& before = show_.session->world;
  if (before.seed() != show_.scene_seed) options.seed = before.seed();  // the performer has set it
  script::SceneOptions run_options = options;
  run_options.sources = run.files.sources;
  const Result<void> result = run.files.fails ? Result<void>(Error{"it failed when the take was recorded, too"})
                                              : fresh->run(show_.options.scene, host_, run_options);
  if (!result) {
    show_.output().report_fault(
        fmt::format("reset: the scene file has an error, so the show continues unchanged: {}", result.error()));
    return false;
  }
  recording_.run_succeeded(run.index, *fresh);
  capture_run(*fresh, options, show_.options.scene);
  if (options.seed) copy_session_value(*fresh, "seed");
  install_session(std::move(fresh));
  if (show_.session->scene != nullptr) show_.session->scene->enable_jit();  // the JIT was off while two scenes existed
  reapply_overrides();
  begin_show();
  show_.send_transport();
  return true;
}

// Copies a value that is session state, not scene state (paused, speed, history), into a new session.
void SceneRunner::copy_session_value(Session& fresh, std::string_view name) const {
  const Property& property = sim::World::table().at(name);
  const Session& session = *show_.session;
  (void)fresh.store.set(fresh.world.id(), property, {session.store.values(session.world.id(), property), 1});
}

// Makes a session the show, with the session state that survives a reset. Returns the previous session.
std::unique_ptr<Session> SceneRunner::install_session(std::unique_ptr<Session> fresh) {
  for (const char* state : {"paused", "speed", "history"}) copy_session_value(*fresh, state);
  return swap_session(std::move(fresh));
}

// The debug overlay belongs to the user, so it stays as it is across scenes.
std::unique_ptr<Session> SceneRunner::swap_session(std::unique_ptr<Session> fresh) {
  std::unique_ptr<Session>& session = show_.session;
  const Property& overlay = sim::Appearance::table().at("overlay");
  (void)fresh->store.set(fresh->world.visuals().appearance().id(), overlay,
                         {session->store.values(session->world.visuals().appearance().id(), overlay), 1});
  LiveOutput& output = show_.outputs.live();
  output.add_faults(session->world.stability().events());
  show_.handler_queue.clear();
  std::swap(session, fresh);
  show_.history.clear("the scene starts there");
  show_.undo_stack.rebind(fresh->store, session->store);
  if (session->scene != nullptr) session->scene->set_call_log(show_.call_log);
  output.value_snapshotter().reset_store();
  show_.presets.forget_store();
  return fresh;
}

// Applies the overrides to the new session in their order. A value that a reload has released since gets the value of
// the scene again.
void SceneRunner::reapply_overrides() {
  struct Value {
    PropertyRef ref;
    std::array<double, 4> values{};
  };
  const std::vector<Override> steps = show_.overrides.in_order();
  Session& session = *show_.session;
  Store& store = session.store;
  std::vector<Value> scene_values;
  for (const Override& step : steps) {
    if (step.address == nullptr) continue;
    const Result<PropertyRef> ref = find_property(store, *step.address);
    scene_values.push_back({ref ? *ref : PropertyRef{}, {}});
    if (ref && ref->property != nullptr) store.get(ref->node, *ref->property, scene_values.back().values.data());
  }
  auto next = scene_values.begin();
  for (const Override& step : steps) {
    if (step.message != nullptr) (void)session.dispatcher.execute(*step.message);
    if (step.blend != nullptr) show_.presets.reapply(session.world, *step.blend);
    if (step.address == nullptr) continue;
    const Value& value = *next++;
    if (value.ref.property != nullptr)
      (void)store.set(value.ref.node, *value.ref.property, {value.values.data(), value.ref.property->width});
  }
}

// Applies a value of --param, after a check of its name.
Result<void> SceneRunner::apply_parameter(const Message& message) {
  Session& session = *show_.session;
  const std::string name = message.address.substr(message.address.rfind('/') + 1);
  const NodeId node = session.scene == nullptr ? NodeId{} : session.scene->params();
  if (!session.store.alive(node))
    return Error{
        fmt::format("--param {}: the scene has no parameters. Declare them with params {{ … }}", printable(name))};
  const PropertyTable& table = session.store.table(node);
  if (table.find(name) == nullptr)
    return Error{fmt::format("--param {}: the scene has no such parameter{}", printable(name),
                             name_hint(name, table.property_names()))};
  return apply_override(message, fmt::format("--param {}", name));
}

// Applies a value of the command line as an override.
Result<void> SceneRunner::apply_override(const Message& message, std::string_view option) {
  const Outcome outcome = show_.session->dispatcher.execute(message);
  if (outcome.kind == Outcome::Kind::answered) {
    return Error{
        fmt::format("{}: this is a query, not a value; set a path, such as /physics/sim/gravity=0,0,-1.6", option)};
  }
  // otherwise the first message of the show would execute it
  if (show_.session->cue_node.consume_request() || outcome.kind == Outcome::Kind::cue_request) {
    return Error{fmt::format(
        "{}: cues start while the show plays. Give the first cue a begin time in the cue file, or send it later with "
        "limber send",
        option)};
  }
  if (outcome.kind != Outcome::Kind::applied) {
    return Error{fmt::format("{}: {}", option,
                             outcome.error.empty()
                                 ? "this is a request to a show that plays; send it later with limber send"
                                 : outcome.error)};
  }
  if (outcome.clamped != nullptr) show_.output().report_clamped(message, *outcome.clamped);
  show_.overrides.add(message);
  return {};
}

// Applies the values of the command line: --recover, --preset, --param, --set.
Result<void> SceneRunner::apply_initial_overrides() {
  if (Result<void> recovered = recovery_.apply(); !recovered) return recovered;
  MessageDispatcher& dispatcher = show_.session->dispatcher;
  if (!show_.options.preset.empty()) {
    const Outcome outcome = dispatcher.execute({"/preset/recall", {Arg::of(show_.options.preset)}});
    if (outcome.kind != Outcome::Kind::applied) return Error{fmt::format("--preset: {}", outcome.error)};
    if (!outcome.warning.empty()) show_.output().warn_once(outcome.warning);
  }
  for (const Message& message : show_.options.params) {
    if (Result<void> set = apply_parameter(message); !set) return set;
  }
  for (const Message& message : show_.options.sets) {
    if (Result<void> set = apply_override(message, fmt::format("--set {}", printable(message.address))); !set)
      return set;
  }
  return {};
}

Presets::Bank SceneRunner::read_presets(const std::string& scene) {
  const std::string& given = show_.options.files.presets;
  PresetFile::WriteAccess access = PresetFile::write_access_for(
      given.empty() ? scene : given, show_.options.files.locks, !show_.options.recovery.folder.empty());
  const std::string path = !given.empty() ? given : scene.empty() ? "" : PresetFile::path_for(scene);
  // called by the thread that writes the file: not through Output, which belongs to the simulation thread
  return Presets::read(show_.writer, path, std::move(access), [&link = show_.link](const std::string& why) {
    link.push_out({Outgoing::Destination::error, {}, error_message("/preset/store", why)});
  });
}

Result<void> SceneRunner::run_between_ticks(const std::function<void()>& work) {
  Result<void> done = Error{"the show has ended"};
  const auto work_of_show = [&] {
    done = show_.input->accepts_changes();
    if (done) work();
  };
  requests_.run_and_wait(work_of_show, [this] { show_.pacer.wake(); });
  return done;
}

bool SceneRunner::reload(bool reuse_files) {
  constexpr int kTries = 3;
  for (int i = 0; i < kTries; i++) {
    ReloadRequest request;
    const auto copy_request = [&] {
      begin_run(TakeSceneRun::Kind::reload_requested, reuse_files);
      request = reloader_.make_request(*show_.session, reuse_files);
    };
    if (!run_between_ticks(copy_request)) return false;
    ReloadCandidate candidate(std::move(request), host_);
    SceneReloader::ApplyResult result = SceneReloader::ApplyResult::outdated;
    const auto apply_request = [&] {
      const Run run = begin_run(TakeSceneRun::Kind::reload_finished);
      result = apply_candidate(candidate);
      if (result == SceneReloader::ApplyResult::applied) recording_.run_succeeded(run.index, *show_.session);
    };
    if (!run_between_ticks(apply_request)) return false;
    if (result != SceneReloader::ApplyResult::outdated) return true;
  }
  // resets have made each candidate outdated, so reload within a tick
  return run_between_ticks([&] { run_now(TakeSceneRun::Kind::reload, reuse_files); }).ok();
}

SceneReloader::ApplyResult SceneRunner::run_now(TakeSceneRun::Kind kind, bool reuse_files) {
  const Run run = begin_run(kind, reuse_files);
  ReloadRequest request = reloader_.make_request(*show_.session, reuse_files);
  if (run.files.fails) return SceneReloader::ApplyResult::failed;
  request.options.sources = run.files.sources;
  ReloadCandidate candidate(std::move(request), host_);
  const SceneReloader::ApplyResult result = apply_candidate(candidate);
  if (result == SceneReloader::ApplyResult::applied) recording_.run_succeeded(run.index, *show_.session);
  return result;
}

SceneReloader::ApplyResult SceneRunner::apply_candidate(ReloadCandidate& candidate) {
  Session& session = *show_.session;
  const bool is_start = session.scene == nullptr;
  candidate.scene()->set_call_log(show_.call_log);
  const SceneReloader::ApplyResult result = [&] {
    const EditScope edit_scope = show_.edit_scope();
    return reloader_.apply_candidate(candidate, session);
  }();
  if (result != SceneReloader::ApplyResult::applied) return result;
  show_.history.clear("the scene was run again there");
  show_.presets.set_script_preset(reloader_.script_preset());
  static const Property& seed = sim::World::table().at("seed");
  if ((candidate.diff().singles[kWorldNode] >> seed.index & 1u) != 0) show_.scene_seed = session.world.seed();
  if (!is_start) return result;
  show_.scene_seed = session.world.seed();
  if (show_.rules.frames_scenes) sim::frame_scene(session.world);
  if (const Result<void> set = apply_initial_overrides(); !set) log_error("{}", set.error());
  begin_show();
  return result;
}

// Begins a run of the scene with one more line; its inputs are copied between two ticks.
ReloadRequest SceneRunner::request_with(const AddedModel& model) {
  show_.added += lua_line(model, model.path);
  reloader_.set_added(show_.added);
  begin_run(TakeSceneRun::Kind::reload_requested, true);
  return reloader_.make_request(*show_.session, true);
}

// Applies the run to the show. If it has failed, the line is removed, and the show stays as it is.
Result<void> SceneRunner::apply_added(ReloadCandidate& candidate, const std::string& previous) {
  const Run run = begin_run(TakeSceneRun::Kind::reload_finished);
  Result<void> result = candidate.result();
  SceneReloader::ApplyResult applied = SceneReloader::ApplyResult::failed;
  if (result) applied = apply_candidate(candidate);
  if (applied == SceneReloader::ApplyResult::applied) {
    recording_.run_succeeded(run.index, *show_.session);
    reloader_.update_files();
    return {};
  }
  show_.added = previous;
  reloader_.set_added(previous);
  return result ? Error{"the scene was reset or reloaded meanwhile; try again"} : result;
}

Result<AddedModel> SceneRunner::add_model(const std::string& path, const model::BodyModel& model) {
  constexpr int kTries = 3;  // the first ones may be outdated by resets and reloads
  Result<AddedModel> result = Error{};
  for (int i = 0; i < kTries && !result; i++) {
    std::optional<ReloadRequest> request;
    AddedModel added;
    std::string previous;
    Result<void> done = run_between_ticks([&] {
      if (show_.session->scene == nullptr) return;
      std::vector<std::string> names = reloader_.body_names();
      for (const std::string_view name : show_.session->world.body_names()) names.emplace_back(name);
      added = place_model(show_.session->world, path, model, names);
      previous = show_.added;
      request = request_with(added);
    });
    if (!done) return Error{done.error()};
    if (!request) return Error{"the scene has an error; models can be added once it is fixed"};
    ReloadCandidate candidate(std::move(*request), host_);
    Result<void> applied;
    done = run_between_ticks([&] { applied = apply_added(candidate, previous); });
    if (!done) return Error{done.error()};
    result = applied ? Result<AddedModel>(added) : Result<AddedModel>(Error{applied.error()});
    if (!candidate.result()) break;
  }
  return result;
}

Result<void> SceneRunner::change_scene(const std::string& file, std::optional<std::uint64_t> panics) {
  const std::uint64_t panics_at_request = panics.value_or(show_.link.panics.load());
  auto fresh = show_.new_session();
  Result<void> run_result = fresh->run_detached(file, host_, show_.options.scene_options);
  if (!run_result) return run_result;
  Presets::Bank bank = read_presets(file);
  // the previous session and presets are destroyed at the end of this function, on this thread
  Result<void> result;
  const Result<void> done = run_between_ticks([&] {
    if (show_.link.panics.load() != panics_at_request) {
      show_.output().count(&Counters::discarded);
      result = Error{"discarded: a panic was requested before it could start"};
      return;
    }
    const Run run = begin_run(TakeSceneRun::Kind::scene, false, file);
    recording_.run_succeeded(run.index, *fresh, bank.list, bank.file);
    play_scene(file, fresh, bank);
  });
  return done ? result : done;
}

void SceneRunner::play_scene(const std::string& file, std::unique_ptr<Session>& fresh, Presets::Bank& bank) {
  show_.options.scene = file;
  show_.added.clear();
  show_.overrides.clear();
  show_.undo_stack.clear();
  capture_run(*fresh, show_.scene_options(), file);
  bank = show_.presets.open(std::move(bank));
  if (show_.session->scene != nullptr) show_.session->scene->disable_jit();
  fresh = install_session(std::move(fresh));
  show_.session->make_live(host_);
  show_.scene_seed = show_.session->world.seed();
  begin_show();
  show_.send_transport();
}

void SceneRunner::rerun_if_requested() {
  if (!reloader_.consume_rerun(*show_.session)) return;
  if (show_.input->must_rerun()) run_now(TakeSceneRun::Kind::rerun, true);
}

}  // namespace limber::engine
