// Engine: start, reset, the loop and the phases of a tick.
#include "engine/engine.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/math/fixed_math.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "engine/commands/console_params.h"

namespace limber {

namespace {

// Longest wait between two checks of the command queue, so that commands take effect even if the next tick is far away.
constexpr auto kMaxWait = std::chrono::milliseconds(50);
// Costs in units of kTickWork: a rejection or an answer, a message to the scene's handlers, a console evaluation.
constexpr int kTextWork = 7;
constexpr int kHandlerWork = 3;
constexpr int kEvaluationWork = 512;

// Measures intervals: lap() returns the seconds since the previous lap() or the construction.
class Stopwatch {
 public:
  double lap() {
    const double now = system::clock_seconds();
    return now - std::exchange(last_, now);
  }

 private:
  double last_ = system::clock_seconds();
};

}  // namespace

Engine::Engine(EngineLink& link, EngineOptions options)
    : link_(link),
      options_(std::move(options)),
      thread_pool_(options_.threads > 1 ? std::make_shared<ThreadPool>(options_.threads) : nullptr),
      session_(new_session()),
      reloader_(options_.scene, *this, overrides_) {
  link_.wake_engine = [this] { commands_waiting_.store(true, std::memory_order_relaxed); };
}

std::unique_ptr<Session> Engine::new_session() {
  WorldSetup setup;
  setup.thread_pool = thread_pool_;
  return std::make_unique<Session>(link_, presets_, undo_stack_, setup);
}

Engine::~Engine() {
  end_take();
  link_.wake_engine = [] {};
}

Result<void> Engine::start() {
  if (!options_.replay.empty()) return start_replay();
  open_recovery();
  if (!options_.record.empty()) {
    if (Result<void> recorded = start_recording(); !recorded) return recorded;
  }
  presets_.open(read_presets(options_.scene));
  Result<void> started = start_show();
  if (started) finish_take_tick(false, true);
  if (!started) abandon_recording();
  if (recovery_ != nullptr) recovery_->begin();
  return started;
}

Result<void> Engine::start_show() {
  const RecordedRun run = begin_run(TakeSceneRun::Kind::start);
  const SceneOptions options = scene_options();
  SceneOptions run_options = options;
  run_options.sources = run.sources;
  if (run.fails) return Error{"the scene failed when the take was recorded, too"};
  if (Result<void> result = session_->run(options_.scene, *this, run_options); !result) {
    std::vector<SourceFile> tried_files = session_->scene->sources()->files();
    session_ = new_session();
    reloader_.capture(*session_, options, options_.scene, std::move(tried_files));
    presets_.set_script_preset(reloader_.script_preset());
    return result;
  }
  if (session_->scene != nullptr) session_->scene->set_call_log(call_log_);
  run_succeeded(run, *session_, presets_.list(), presets_.file());
  reloader_.capture(*session_, options, options_.scene);
  presets_.set_script_preset(reloader_.script_preset());
  World& world = session_->world;
  if (options_.scene_options.seed) {
    const auto seed = static_cast<double>(*options_.scene_options.seed);
    (void)session_->store.set(world.id(), "seed", {&seed, 1});  // can't fail: any 53-bit seed is in range
  }
  scene_seed_ = world.seed();
  if (Result<void> set = apply_initial_overrides(); !set) return set;
  begin_show();
  publish();
  return {};
}

// The initial overrides may require another run of the scene (parameters with `rerun`), before its on_start.
void Engine::begin_show() {
  if (reloader_.consume_rerun(*session_)) run_scene_now(TakeSceneRun::Kind::rerun, true);
  session_->world.flush();
  if (session_->scene != nullptr) session_->scene->start();
  presets_.finish_planning(session_->world);
}

bool Engine::reset() {
  stall_excused_ = true;
  const RecordedRun run = begin_run(TakeSceneRun::Kind::reset);
  // a scene that fails leaves the show unchanged
  auto fresh = new_session();
  SceneOptions options = scene_options();
  const World& before = session_->world;
  if (before.seed() != scene_seed_) options.seed = before.seed();  // the performer has set it
  SceneOptions run_options = options;
  run_options.sources = run.sources;
  const Result<void> result = run.fails ? Result<void>(Error{"it failed when the take was recorded, too"})
                                        : fresh->run(options_.scene, *this, run_options);
  if (!result) {
    faults_++;
    log_error("reset: the scene file has an error, so the show continues unchanged: {}", result.error());
    return false;
  }
  run_succeeded(run, *fresh);
  reloader_.capture(*fresh, options, options_.scene);
  presets_.set_script_preset(reloader_.script_preset());
  if (options.seed) copy_session_value(*fresh, "seed");
  install_session(std::move(fresh));
  if (session_->scene != nullptr) session_->scene->arm();  // the JIT was off while two scenes existed
  reapply_overrides();
  begin_show();
  send_transport();
  return true;
}

// Copies a value that is session state, not scene state (paused, speed, history), into a new session.
void Engine::copy_session_value(Session& fresh, std::string_view name) const {
  const Property& property = World::table().at(name);
  (void)fresh.store.set(fresh.world.id(), property, {session_->store.values(session_->world.id(), property), 1});
}

std::unique_ptr<Session> Engine::install_session(std::unique_ptr<Session> fresh) {
  for (const char* state : {"paused", "speed", "history"}) copy_session_value(*fresh, state);
  return swap_session(std::move(fresh));
}

// The debug overlay belongs to the user, so it stays as it is across scenes.
std::unique_ptr<Session> Engine::swap_session(std::unique_ptr<Session> fresh) {
  const Property& overlay = Appearance::table().at("overlay");
  (void)fresh->store.set(fresh->world.visuals().appearance().id(), overlay,
                         {session_->store.values(session_->world.visuals().appearance().id(), overlay), 1});
  faults_ += session_->world.health_events();
  handler_queue_.clear();
  std::swap(session_, fresh);
  history_.clear("the scene starts there");
  undo_stack_.rebind(fresh->store, session_->store);
  if (session_->scene != nullptr) session_->scene->set_call_log(call_log_);
  value_snapshotter_.reset_store();
  presets_.forget_store();
  return fresh;
}

// Applies the overrides to the new session in their order. A value that a reload has released since gets the value of
// the scene again.
void Engine::reapply_overrides() {
  struct Value {
    PropertyRef ref;
    std::array<double, 4> values{};
  };
  const std::vector<Override> steps = overrides_.in_order();
  Store& store = session_->store;
  std::vector<Value> scene_values;
  for (const Override& step : steps) {
    if (step.address == nullptr) continue;
    const Result<PropertyRef> ref = find_property(store, *step.address);
    scene_values.push_back({ref ? *ref : PropertyRef{}, {}});
    if (ref && ref->property != nullptr) store.get(ref->node, *ref->property, scene_values.back().values.data());
  }
  auto next = scene_values.begin();
  for (const Override& step : steps) {
    if (step.message != nullptr) (void)session_->dispatcher.execute(*step.message);
    if (step.blend != nullptr) presets_.reapply(session_->world, *step.blend);
    if (step.address == nullptr) continue;
    const Value& value = *next++;
    if (value.ref.property != nullptr)
      (void)store.set(value.ref.node, *value.ref.property, {value.values.data(), value.ref.property->width});
  }
}

void Engine::run() {
  if (!is_replaying()) executor_.open();
  clock_.restart(Clock::Time::clock::now());
  while (!stop_.load(std::memory_order_relaxed) && !finished()) {
    options_.on_iteration();
    // a replay does not wait for passes without a time step
    const bool immediately =
        is_replaying() ? options_.fast || !player_->steps_next() : options_.fast && !session_->transport.paused();
    if (immediately) {
      clock_.measure_speed(Clock::Time::clock::now(), session_->world.timestep());
      run_pass(true);
    } else if (wait_for_tick()) {
      pace();
      run_pass(true);
    } else if (commands_waiting_.exchange(false, std::memory_order_relaxed) || link_.panic_signal.load() ||
               !handler_queue_.empty()) {
      run_pass(false);
    }
  }
  executor_.close();
  end_take();
}

// Returns false if the tick is not due yet, but requests or commands may wait for a pass.
bool Engine::wait_for_tick() {
  const auto next_tick = clock_.next_tick();
  const auto until = std::min(next_tick, Clock::Time::clock::now() + kMaxWait);
  std::unique_lock lock(wake_mutex_);
  const bool requested =
      wake_.wait_until(lock, until, [this] { return stop_.load(std::memory_order_relaxed) || executor_.waiting(); });
  return until == next_tick && !requested;
}

void Engine::pace() {
  static const Property& speed_property = World::table().at("speed");
  World& world = session_->world;
  const double speed = session_->store.values(world.id(), speed_property)[0];
  clock_.tick(Clock::Time::clock::now(), world.timestep(), speed);
  count_stall();
  if (clock_.consume_late() && !session_->transport.paused()) {
    log_warning(
        "time runs at {:.2f} × real time instead of {}: this machine can't keep up; fewer substeps or "
        "solver_iterations would help",
        clock_.speed_reached(), speed);
  }
}

// Counts interruptions. A machine that is permanently too slow loses time in small pieces, which pace() reports.
void Engine::count_stall() {
  constexpr double kReportSeconds = 0.5;  // s
  const double lost = clock_.lost_seconds(system::suspended_seconds());
  if (std::exchange(stall_excused_, false) || session_->transport.paused()) return;
  lost_time_ += lost;
  if (lost < kReportSeconds || std::exchange(stall_reported_, true)) return;
  log_warning(
      "the show was stalled for {:.1f} s: the program was stopped, or the machine was suspended or busy. The lost time "
      "is not caught up. Reported once; /transport/lost_time has the total",
      lost);
}

bool Engine::finished() const {
  if (is_replaying() && !plays_in_show_ && player_->finished()) return true;
  if (options_.strict && faults() > 0) return true;
  if (options_.ticks && session_->world.tick() >= *options_.ticks) return true;
  return options_.duration && session_->world.time() >= *options_.duration - 1e-9;
}

void Engine::stop() {
  {
    const std::scoped_lock lock(wake_mutex_);
    stop_.store(true);
  }
  wake_.notify_all();
}

void Engine::run_pass(bool may_step) {
  fixed::reset_arithmetic();
  Stopwatch watch;
  call_log_.begin_tick();
  executor_.serve();
  if (plays_in_show_ && (link_.panic_signal.load() || link_.command_queue.has_urgent(UrgentKind::panic))) end_play();
  if (is_replaying() && !next_replay_tick(may_step)) {
    if (!plays_in_show_) return;
    end_play();
  }
  rerun_if_requested();
  update_panic_age(may_step);
  execute_commands();
  times_.commands = watch.lap();

  Session& session = *session_;
  const bool advances = may_step && (!session.transport.paused() || session.transport.consume_step());
  const bool running = is_replaying() ? may_step : advances;  // in a replay the take decides
  simulate(running);
  watch.lap();

  if (requested_take_) {
    begin_recording();
  } else {
    if (session.world.consume_reset_request()) reset();
    finish_take_tick(running);
  }
  if (std::exchange(take_end_requested_, false)) {
    end_take();
    if (plays_in_show_) end_play();
  }
  update_health();
  publish();
  make_value_snapshot(snapshot_requests_);
  if (was_paused_ != session_->transport.paused()) send_transport();
  times_.snapshot = watch.lap();
  presets_.prepare(session_->world);
  if (recovery_ != nullptr && !is_replaying() && recovery_->wants_values()) update_recovery();
  if (session_->scene != nullptr) session_->scene->collect_garbage();
  end_pass(running);
  times_.gc = watch.lap();
}

// The part of a tick after its commands: morphs, handlers, scene callbacks and, if `running`, a physics step.
void Engine::simulate(bool running) {
  Session& session = *session_;
  Stopwatch watch;
  end_panic();
  if (running) presets_.advance(session.world);
  call_handlers();
  if (running && session.scene != nullptr && !session.world.panic().on()) session.scene->tick(session.world.timestep());
  execute_preset_requests();
  begin_panic();
  undo_stack_.end(session.store);
  if (!resimulating_) change_recorder_.flush(session.store);
  times_.scripts = watch.lap();
  if (!running) return session.world.flush();
  session.dispatcher.apply_mouse_springs();
  session.world.step();
  const TickTimes& physics = session.world.times();
  times_.behaviors = physics.behaviors;
  times_.callbacks = physics.flush;
  times_.physics = physics.physics;
  times_.readouts = physics.readouts;
  send_contacts();
}

void Engine::publish() {
  session_->counters.publish();
  session_->preset_node.publish();
  update_transport();
  update_take_node();
  session_->publisher.publish(session_->transport.paused(), clock_.speed_reached(), times_);
}

void Engine::make_value_snapshot(std::uint64_t requests) {
  if (!value_snapshotter_.make(session_->store, link_.snapshots.read(), requests)) return;
  link_.wake_network();
  link_.wake_query();
}

void Engine::execute_commands() {
  session_->dispatcher.begin_tick();
  (void)session_->transport.consume_rewind();  // drops a rewind request of the command line
  EditScope edit_scope(session_->world, presets_, undo_stack_, change_recorder_);
  if (is_replaying()) return replay_messages(edit_scope);
  execute_urgent(edit_scope);
  answer_pending_queries(edit_scope);
  const double start_time = options_.clock();
  bool drained = false;
  for (int work = kTickWork; work > 0;) {
    if (next_command_ < commands_.size()) {
      Command& command = commands_[next_command_++];
      edit_scope.begin(command.origin);
      for (Message& message : command.messages) {
        work--;
        if (discard_if_overtaken(message, command.arrival) || postpone_query(message, command.origin)) continue;
        work -= execute(message, command.origin);
        if (std::exchange(rewound_, false)) edit_scope.begin(command.origin);
      }
      if (command.evaluation == nullptr) continue;
      evaluate(*command.evaluation, command.origin);
      work -= kEvaluationWork;
      if (!options_.fast && options_.clock() - start_time > kHandlerSeconds) break;
      continue;
    }
    snapshot_requests_ = snapshot_requests_of_batch_;
    if (std::exchange(drained, true)) break;
    // before the queue is drained, because a value snapshot must contain all commands that came before its request
    snapshot_requests_of_batch_ = link_.value_snapshot_requests.load();
    link_.command_queue.drain(commands_);
    next_command_ = 0;
  }
}

// Scene parameters that the text sets become overrides, except in replays of older takes.
Evaluation Engine::evaluate_text(std::string_view text) {
  Scene& scene = *session_->scene;
  const ConsoleParams console_params(session_->store, scene.params());
  Evaluation result = scene.evaluate(text);
  if (!is_replaying() || player_->keeps_timers()) console_params.add_to(overrides_);
  return result;
}

// An error in the text is returned to its author and is not counted as a fault of the show.
void Engine::evaluate(const EvaluationRequest& request, const CommandOrigin& origin) {
  Evaluation result{Evaluation::Kind::error, "there is no scene to evaluate in"};
  const std::uint64_t before = log_newest();
  if (request.text.size() > kMaxEvaluatedBytes) {
    result.text = fmt::format("the text must have at most {} bytes, got {}", kMaxEvaluatedBytes, request.text.size());
  } else if (session_->scene != nullptr) {
    Scene& scene = *session_->scene;
    if (request.action == EvaluationRequest::Action::run) {
      if (recorder_ != nullptr) recorder_->record_evaluation(request.text, origin);
      history_.record_input({request.text, {}}, origin, true);
    }
    result =
        request.action == EvaluationRequest::Action::run ? evaluate_text(request.text) : scene.complete(request.text);
  }
  result.log_before = before;
  result.log_after = log_newest();
  request.on_result(std::move(result));
}

int Engine::execute(Message& message, const CommandOrigin& origin) {
  Outcome outcome = session_->dispatcher.execute(message);
  const std::optional<Transport::RewindRequest> rewind_request = session_->transport.consume_rewind();
  if (rewind_request && !resimulating_) {
    outcome = rewind(*rewind_request, origin);
    rewound_ = true;
  } else if (!resimulating_) {
    if (recorder_ != nullptr) recorder_->record_message(message, origin);
    history_.record_input(message, origin);
  }
  if (outcome.kind == Outcome::Kind::take_request && !resimulating_) outcome = request_take(message);
  if (outcome.kind == Outcome::Kind::scene_request && (!link_.on_scene_request || resimulating_))
    outcome.kind = Outcome::Kind::rejected;
  if (outcome.clamped != nullptr && !resimulating_) {
    link_.counters.clamped.fetch_add(1, std::memory_order_relaxed);
    report_clamped(message, *outcome.clamped);
  }
  if (outcome.sets_override) overrides_.add(message);
  if (origin.is_subscriber && !resimulating_ && outcome.kind == Outcome::Kind::applied) {
    for (const MessageDispatcher::Write& write : session_->dispatcher.writes())
      value_snapshotter_.note_write(session_->store, origin, write.ref, write.ref.property == outcome.clamped);
  }
  if (!outcome.warning.empty() && !resimulating_) {
    report_warning(outcome.warning);
    send_error(message.address, origin, outcome.warning);
  }
  for (Message& answer : outcome.answers) push_out({Outgoing::Destination::sender, origin, std::move(answer)});
  if (outcome.kind == Outcome::Kind::rejected && !resimulating_) {
    link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    faults_++;
    send_error(message.address, origin, outcome.error);
  }
  if (outcome.kind == Outcome::Kind::scene_request) link_.on_scene_request(message, origin);
  const bool unknown = outcome.kind == Outcome::Kind::unknown;
  const bool has_handlers = session_->scene != nullptr && session_->scene->has_handlers();
  const bool applied = outcome.kind == Outcome::Kind::applied;
  const int work = static_cast<int>(session_->dispatcher.writes().size()) + (applied ? 0 : kTextWork) +
                   (has_handlers ? kHandlerWork : 0);
  // the scene's handlers are called after all messages of the tick have taken effect
  if (rewind_request) return work;
  if (has_handlers) {
    const bool fits =
        handler_queue_.push({std::move(message), origin, unknown, std::move(outcome.error)}, has_current_rules());
    if (!fits && !resimulating_) link_.counters.unheard.fetch_add(1, std::memory_order_relaxed);
  } else if (unknown && !resimulating_) {
    link_.counters.unknown.fetch_add(1, std::memory_order_relaxed);
    send_error(message.address, origin, outcome.error);
  }
  return work;
}

std::uint64_t Engine::state_hash() const {
  const std::uint64_t hash = session_->world.state_hash();
  return session_->scene == nullptr ? hash : session_->scene->state_hash(hash);
}

void Engine::request_reset() { session_->world.request_reset(); }

}  // namespace limber
