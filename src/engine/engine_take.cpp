// Engine: recording and replay of takes.
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/text.h"
#include "engine/engine.h"
#include "engine/reload/reload_candidate.h"

namespace limber {

namespace {

constexpr std::size_t kMaxName = 100;
constexpr int kRejectionWork = 8;  // same cost as a rejected message
constexpr const char* kReplayingError = "a take is being replayed; messages are rejected";
constexpr const char* kPlayingError = "a take plays; /take/stop ends it";

// Returns the name of a new take from the message, or one made of scene and time. A name from a message must not lead
// into another folder.
Result<std::string> requested_take_name(const Message& message, const std::string& scene) {
  if (!message.args.empty() && !message.args[0].text.empty()) {
    std::string name = message.args[0].text;
    if (name.ends_with(".take")) name.resize(name.size() - 5);
    const bool plain = !name.empty() && name.size() <= kMaxName && name.front() != '.' &&
                       name.find_first_of("/\\") == name.npos &&
                       std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    if (!plain)
      return Error{fmt::format(
          "'{}' is not a valid name of a take; use a name without / that does not begin with a dot", printable(name))};
    return name;
  }
  // the time is only used for the file name: the simulation never reads it
  const std::time_t now = std::time(nullptr);
  std::tm local_time{};
  localtime_r(&now, &local_time);
  char text[32] = {};
  (void)std::strftime(text, sizeof text, "%Y-%m-%d-%H%M%S", &local_time);
  return fmt::format("{}-{}", std::filesystem::path(scene).stem().string(), text);
}

}  // namespace

std::function<void(const std::string&)> Engine::take_error_reporter() {
  return [this](const std::string& why) {
    log_error("{}", why);
    link_.push_out({Outgoing::Destination::error, {}, error_message("/take/record", why)});
  };
}

TakeInitialState Engine::make_initial_state(bool reset) const {
  TakeInitialState state;
  state.reset = reset;
  state.scene = options_.scene;
  state.seed = options_.scene_options.seed;
  state.package_paths = options_.scene_options.package_paths;
  state.preset = options_.preset;
  state.sets = options_.sets;
  if (recovered_ != nullptr && !reset) state.recovered = {recovered_};
  if (!reset) return state;
  state.world_seed = session_->world.seed();
  state.scene_seed = scene_seed_;
  state.paused = session_->world_value("paused") != 0;
  state.speed = session_->world_value("speed");
  state.preset_file = presets_.file();
  state.presets = presets_.list();
  for (const Override& override_entry : overrides_.in_order()) {
    TakeOverride& entry = state.overrides.emplace_back();
    if (override_entry.message != nullptr) entry.message = *override_entry.message;
    if (override_entry.address != nullptr) {
      entry.kind = TakeOverride::Kind::released;
      entry.message.address = *override_entry.address;
    }
    if (override_entry.blend == nullptr) continue;
    entry.kind = TakeOverride::Kind::blend;
    entry.presets = {override_entry.blend->a};
    if (override_entry.blend->amount > 0) entry.presets.push_back(override_entry.blend->b);
    entry.amount = override_entry.blend->amount;
  }
  return state;
}

Result<void> Engine::start_recording() {
  call_log_.begin_tick();
  recorder_ = std::make_unique<TakeRecorder>(TakeWriter::Target{options_.record, false}, make_initial_state(false),
                                             take_error_reporter());
  Result<void> opened = recorder_->wait_until_open();
  if (!opened) recorder_ = nullptr;
  take_name_ = title_of_take(options_.record);
  return opened;
}

Engine::RecordedRun Engine::begin_run(TakeSceneRun::Kind kind, bool reuse_files, const std::string& scene) {
  RecordedRun scene_run;
  if (recorder_ != nullptr) scene_run.index = recorder_->begin_run({kind, false, reuse_files, 0, scene});
  if (player_ == nullptr) return scene_run;
  scene_run.recorded = player_->consume_run(kind);
  if (player_->current_scripts()) return scene_run;
  scene_run.fails = scene_run.recorded == nullptr || !scene_run.recorded->succeeded;
  if (!scene_run.fails) scene_run.sources = player_->sources(*scene_run.recorded);
  return scene_run;
}

void Engine::run_succeeded(const RecordedRun& run, const Session& session, std::optional<PresetList> presets,
                           const std::string& preset_file) {
  if (recorder_ == nullptr) return;
  recorder_->run_succeeded(
      run.index, {session.scene == nullptr ? nullptr : session.scene->sources(), std::move(presets), preset_file});
}

Outcome Engine::request_take(const Message& message) {
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  if (is_replaying()) return outcome;
  const std::string address = plain_name(message.address);
  if (address == "/take/stop") {
    if (recorder_ == nullptr) return Outcome::rejected("no take is being recorded; /take/record starts one");
    take_end_requested_ = true;
    outcome.answers.push_back({"/take/stopped", {}});
    return outcome;
  }
  if (recorder_ != nullptr || requested_take_)
    return Outcome::rejected("a take is being recorded already; /take/stop ends it");
  if (address == "/take/play") {
    if (!link_.on_scene_request) return Outcome::rejected("takes can be played only in limber play, without --fast");
    outcome.kind = Outcome::Kind::scene_request;
    return outcome;
  }
  if (session_->scene == nullptr) return Outcome::rejected("there is no scene to record");
  const Result<std::string> name = requested_take_name(message, options_.scene);
  if (!name) return Outcome::rejected(name.error());
  const std::string& show = session_->scene->show_folder();
  const std::string folder = (std::filesystem::path(show) / "takes").string();
  if (!is_inside(folder, show))
    return Outcome::rejected("takes/ is a link that leads out of the show's folder; put a folder in its place");
  requested_take_ = folder + "/" + *name + ".take";
  outcome.answers.push_back({"/take/recording", {Arg::of(*name)}});
  return outcome;
}

// Resets the scene and records from there: a take begins with a run of the scene from its start.
void Engine::begin_recording() {
  const std::string file = *std::exchange(requested_take_, std::nullopt);
  (void)session_->world.consume_reset_request();
  take_name_ = title_of_take(file);
  undo_stack_.clear();  // undo steps from before the take can't be replayed
  call_log_.begin_tick();
  recorder_ =
      std::make_unique<TakeRecorder>(TakeWriter::Target{file, true}, make_initial_state(true), take_error_reporter());
  if (reset()) {
    log_info("recording the take {}", printable(file));
    finish_take_tick(false, true);
  } else {
    abandon_recording();
    take_error_reporter()("the take was not started: the scene's file has an error");
  }
}

void Engine::abandon_recording() {
  if (recorder_ == nullptr) return;
  ended_takes_.push_back(recorder_->abandon());
  recorder_ = nullptr;
}

void Engine::end_take() {
  if (recorder_ == nullptr) return;
  ended_takes_.push_back(recorder_->finish({session_->world.tick(), state_hash()}));
  recorder_ = nullptr;
}

void Engine::finish_saving() {
  presets_.finish_saving();
  ended_takes_.clear();
}

void Engine::update_take_node() {
  TakeNode::Status status;
  if (player_ != nullptr) status = {take_name_, true, player_->ticks(), player_->total_ticks(), plays_in_show_};
  if (recorder_ != nullptr) status = {take_name_, false, recorder_->ticks(), 0, false};
  session_->take_node.publish(status);
}

void Engine::finish_take_tick(bool running, bool begins) {
  const auto hash = [this] { return state_hash(); };
  if (player_ != nullptr) player_->compare(session_->world, call_log_, hash);
  if (recorder_ != nullptr && recorder_->failed()) end_take();
  if (recorder_ != nullptr) recorder_->end_tick(running, session_->world, call_log_, hash, begins);
  if (!ended_takes_.empty()) std::erase_if(ended_takes_, [](const auto& writer) { return writer->done(); });
}

Result<void> Engine::start_from_take() {
  const TakeInitialState& initial_state = player_->initial_state();
  if (!initial_state.reset) {
    const std::vector<TakeSceneRun>& runs = player_->tick().runs;
    auto bank = runs.empty() ? std::nullopt : player_->presets(runs.front());
    if (bank) presets_.open({std::move(bank->list), nullptr, bank->file});
    return start_show();
  }
  presets_.open({initial_state.presets, nullptr, initial_state.preset_file});
  for (const TakeOverride& entry : initial_state.overrides) {
    if (entry.kind == TakeOverride::Kind::message) overrides_.add(entry.message);
    if (entry.kind == TakeOverride::Kind::released) overrides_.release(entry.message.address);
    if (entry.kind != TakeOverride::Kind::blend) continue;
    Blend blend = entry.presets.size() == 1 ? Blend::of(entry.presets[0]) : align(entry.presets[0], entry.presets[1]);
    if (entry.presets.size() > 1) blend.amount = entry.amount;
    overrides_.add_recall(blend);
  }
  const auto set = [&](const char* property, double value) {
    (void)session_->store.set(session_->world.id(), World::table().at(property), {&value, 1});
  };
  set("seed", static_cast<double>(initial_state.world_seed));
  set("paused", initial_state.paused ? 1 : 0);
  set("speed", initial_state.speed);
  scene_seed_ = initial_state.scene_seed;
  return reset() ? Result<void>() : Result<void>(Error{"the scene's file has an error"});
}

void Engine::replay_runs() {
  while (const TakeSceneRun* run = player_->next_external_run()) replay_run(*run);
}

void Engine::replay_run(const TakeSceneRun& run) {
  if (run.kind == TakeSceneRun::Kind::reload) {
    run_scene_now(run.kind, run.reuses_files);
    return;
  }
  const RecordedRun scene_run = begin_run(run.kind, run.reuses_files, run.scene);
  if (run.kind == TakeSceneRun::Kind::reload_requested) {
    reload_request_ = reloader_.make_request(*session_, run.reuses_files);
  } else if (run.kind == TakeSceneRun::Kind::reload_finished) {
    if (scene_run.fails || !reload_request_) return;
    reload_request_->options.sources = scene_run.sources;
    ReloadCandidate candidate(*std::exchange(reload_request_, std::nullopt), *this);
    apply_candidate(candidate);
  } else {
    auto session = new_session();
    SceneOptions run_options = scene_options();
    run_options.sources = scene_run.sources;
    if (!session->run_detached(run.scene, *this, run_options)) return;
    auto loaded = player_->presets(run);
    Presets::Bank bank;
    if (loaded) bank = {std::move(loaded->list), nullptr, loaded->file};
    play_scene(run.scene, session, bank);
  }
}

// Handles messages that arrive during a replay: answers queries, rejects the others, within the work budget of a tick.
void Engine::reject_commands() {
  for (int work = kTickWork; work > 0 && next_command_ < commands_.size(); next_command_++) {
    const Command& command = commands_[next_command_];
    for (const Message& message : command.messages) reject_message(message, command.origin);
    if (command.evaluation != nullptr)
      command.evaluation->on_result(
          {Evaluation::Kind::error, plays_in_show_ ? kPlayingError : kReplayingError, 0, 0, 0});
    work -= kRejectionWork * static_cast<int>(1 + command.messages.size());
  }
  snapshot_requests_ = link_.value_snapshot_requests.load();
}

void Engine::reject_urgent() {
  link_.command_queue.drain_urgent(urgent_);
  for (const UrgentRequest& request : urgent_) {
    urgent_precedence_.record(request);
    // a panic stops playback in the next pass, and is executed then
    if (plays_in_show_ && request.kind == UrgentKind::panic) {
      link_.command_queue.push_urgent(request);
      continue;
    }
    if (request.kind == UrgentKind::take_stop) link_.take_stops.fetch_add(1);
    reject_message(request.message, request.origin);
  }
}

void Engine::reject_message(const Message& message, const CommandOrigin& origin) {
  const std::string address = plain_name(message.address);
  Outcome outcome = Outcome::rejected(plays_in_show_ ? kPlayingError : kReplayingError);
  if (plays_in_show_ && address == "/take/stop") {
    take_end_requested_ = true;
    outcome.kind = Outcome::Kind::answered;
    outcome.answers.push_back({"/take/stopped", {}});
  } else if (address == "/get" || address.starts_with("/list/")) {
    outcome = session_->dispatcher.execute(message);
  }
  for (Message& answer : outcome.answers) push_out({Outgoing::Destination::sender, origin, std::move(answer)});
  if (outcome.kind == Outcome::Kind::scene_request && link_.on_scene_request)
    return link_.on_scene_request(message, origin);
  if (outcome.kind != Outcome::Kind::answered) send_error(message.address, origin, outcome.error);
}

void Engine::replay_messages(EditScope& edit_scope) {
  reject_urgent();
  if (next_command_ >= commands_.size()) {
    link_.command_queue.drain(commands_);
    next_command_ = 0;
  }
  reject_commands();
  suppress_answers_ = true;
  replayed_handler_calls_.reset();
  for (TakeMessage& input : player_->messages()) {
    if (!input.evaluate && execute_event(input.message)) {
      history_.record_input(input.message, input.origin);
      continue;
    }
    edit_scope.begin(input.origin);
    if (input.evaluate) {
      EvaluationRequest request;
      request.text = std::move(input.message.address);
      evaluate(request, input.origin);
    } else {
      execute(input.message, input.origin);
    }
  }
}

}  // namespace limber
