// The simulation thread's loop.
#include "engine/engine.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/fixed_math.h"
#include "base/log.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "engine/console_params.h"

namespace limber {

namespace {

// while the next tick is further away than this, commands take effect without waiting for it
constexpr auto kLongestWait = std::chrono::milliseconds(50);
// of a tick's work: a refusal or an answer, and what the scene's handlers may hear
constexpr int kTextWork = 7;
constexpr int kHeardWork = 3;
constexpr int kEvaluationWork = 512;  // a text of a console may compute for long

// the time since the last lap
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
      team_(options_.threads > 1 ? std::make_shared<Team>(options_.threads) : nullptr),
      stage_(new_stage()),
      reload_(options_.scene, *this, hand_) {
  link_.wake_engine = [this] { commands_wait_.store(true, std::memory_order_relaxed); };
}

std::unique_ptr<Stage> Engine::new_stage() {
  WorldSetup setup;
  setup.team = team_;
  return std::make_unique<Stage>(link_, presets_, edits_, setup);
}

Engine::~Engine() {
  end_take();
  link_.wake_engine = [] {};
}

Result<void> Engine::start() {
  if (!options_.replay.empty()) return start_replay();
  open_recovery();
  if (!options_.record.empty()) {
    if (Result<void> recorded = start_record(); !recorded) return recorded;
  }
  presets_.open(read_presets(options_.scene));
  Result<void> started = start_show();
  if (started) take_tick(false, true);
  if (!started) drop_take();
  if (recovery_ != nullptr) recovery_->begin();
  return started;
}

Result<void> Engine::start_show() {
  const TakenRun run = begin_run(TakeRun::Kind::start);
  const SceneOptions live = scene_options();
  SceneOptions run_options = live;
  run_options.sources = run.sources;
  if (run.fails) return Error{"the scene did not run when the take was recorded either"};
  if (Result<void> ran = stage_->run(options_.scene, *this, run_options); !ran) {
    std::vector<SourceFile> tried = stage_->scene->sources()->files();
    stage_ = new_stage();
    reload_.begin(*stage_, live, options_.scene, std::move(tried));
    presets_.scene_says(reload_.script());
    return ran;
  }
  if (stage_->scene != nullptr) stage_->scene->count_calls(calls_);
  run_was_good(run, *stage_, presets_.list(), presets_.file());
  reload_.begin(*stage_, live, options_.scene);
  presets_.scene_says(reload_.script());
  World& world = stage_->world;
  if (options_.scene_options.seed) {
    const auto seed = static_cast<double>(*options_.scene_options.seed);
    (void)stage_->store.set(world.id(), "seed", {&seed, 1});  // any 53-bit seed is in its range
  }
  scene_seed_ = world.seed();
  if (Result<void> set = first_hand(); !set) return set;
  begin_show();
  publish();
  return {};
}

// what the hand has set may want another run before the scene's on_start sees it
void Engine::begin_show() {
  if (reload_.take_rerun(*stage_)) run_now(TakeRun::Kind::rerun, true);
  stage_->world.settle();
  if (stage_->scene != nullptr) stage_->scene->start();
  presets_.make_ready(stage_->world);
}

bool Engine::reset() {
  stall_excused_ = true;
  const TakenRun run = begin_run(TakeRun::Kind::reset);
  // a scene that fails now leaves the show as it is
  auto fresh = new_stage();
  SceneOptions live = scene_options();
  const World& before = stage_->world;
  if (before.seed() != scene_seed_) live.seed = before.seed();  // the performer's
  SceneOptions run_options = live;
  run_options.sources = run.sources;
  const Result<void> ran = run.fails ? Result<void>(Error{"as it had when the take was recorded"})
                                     : fresh->run(options_.scene, *this, run_options);
  if (!ran) {
    faults_++;
    log_error("reset: the scene plays on as it was, its file has an error: {}", ran.error());
    return false;
  }
  run_was_good(run, *fresh);
  reload_.begin(*fresh, live, options_.scene);
  presets_.scene_says(reload_.script());
  if (live.seed) keep_state(*fresh, "seed");
  take_stage(std::move(fresh));
  if (stage_->scene != nullptr) stage_->scene->arm();  // while both were there, the new one ran interpreted
  replay_hand();
  begin_show();
  send_transport();
  return true;
}

// what belongs to the hour, not to the scene
void Engine::keep_state(Stage& fresh, std::string_view name) const {
  const Row& row = World::table().at(name);
  (void)fresh.store.set(fresh.world.id(), row, {stage_->store.values(stage_->world.id(), row), 1});
}

std::unique_ptr<Stage> Engine::take_stage(std::unique_ptr<Stage> fresh) {
  for (const char* state : {"paused", "speed", "history"}) keep_state(*fresh, state);
  return swap_stage(std::move(fresh));
}

// the debug picture is whoever looks's, whatever plays
std::unique_ptr<Stage> Engine::swap_stage(std::unique_ptr<Stage> fresh) {
  const Row& overlay = Look::table().at("overlay");
  (void)fresh->store.set(fresh->world.visuals().look().id(), overlay,
                         {stage_->store.values(stage_->world.visuals().look().id(), overlay), 1});
  faults_ += stage_->world.health_events();
  heard_.clear();
  std::swap(stage_, fresh);
  history_.begin_anew("the scene has begun there");
  edits_.follow(fresh->store, stage_->store);
  if (stage_->scene != nullptr) stage_->scene->count_calls(calls_);
  images_.forget_store();
  presets_.forget_store();
  return fresh;
}

// what the performer set and the scene still has; but what a reload has given back since is as the scene says
void Engine::replay_hand() {
  struct Value {
    Place place;
    std::array<double, 4> values{};
  };
  const std::vector<HandStep> steps = hand_.in_order();
  Store& store = stage_->store;
  std::vector<Value> scenes;
  for (const HandStep& step : steps) {
    if (step.address == nullptr) continue;
    const Result<Place> place = find_place(store, *step.address);
    scenes.push_back({place ? *place : Place{}, {}});
    if (place && place->row != nullptr) store.get(place->node, *place->row, scenes.back().values.data());
  }
  auto next = scenes.begin();
  for (const HandStep& step : steps) {
    if (step.message != nullptr) (void)stage_->dispatch.execute(*step.message);
    if (step.blend != nullptr) presets_.repeat(stage_->world, *step.blend);
    if (step.address == nullptr) continue;
    const Value& value = *next++;
    if (value.place.row != nullptr)
      (void)store.set(value.place.node, *value.place.row, {value.values.data(), value.place.row->width});
  }
}

void Engine::run() {
  if (!replays()) requests_.open();
  clock_.restart(Clock::Time::clock::now());
  while (!stop_.load(std::memory_order_relaxed) && !finished()) {
    options_.on_turn();
    // while time stood still a replay does not wait
    const bool at_once =
        replays() ? options_.fast || !player_->steps_next() : options_.fast && !stage_->transport.paused();
    if (at_once) {
      clock_.measure(Clock::Time::clock::now(), stage_->world.timestep());
      pass(true);
    } else if (wait_for_tick()) {
      pace();
      pass(true);
    } else if (commands_wait_.exchange(false, std::memory_order_relaxed) || link_.panic_signal.load() ||
               !heard_.empty()) {
      pass(false);
    }
  }
  requests_.close();
  end_take();
}

// false: the tick is not due yet, but somebody may wait for an answer
bool Engine::wait_for_tick() {
  const auto due = clock_.due();
  const auto until = std::min(due, Clock::Time::clock::now() + kLongestWait);
  std::unique_lock lock(wake_mutex_);
  const bool called =
      wake_.wait_until(lock, until, [this] { return stop_.load(std::memory_order_relaxed) || requests_.waiting(); });
  return until == due && !called;
}

void Engine::pace() {
  static const Row& speed_row = World::table().at("speed");
  World& world = stage_->world;
  const double speed = stage_->store.values(world.id(), speed_row)[0];
  clock_.tick(Clock::Time::clock::now(), world.timestep(), speed);
  count_stall();
  if (clock_.take_late() && !stage_->transport.paused()) {
    log_warning(
        "time runs at {:.2f} × real time instead of {}: this machine can't keep up; fewer substeps or "
        "solver_iterations would help",
        clock_.speed_reached(), speed);
  }
}

// a machine that is too slow all the time loses it in small pieces, which is said otherwise
void Engine::count_stall() {
  constexpr double kWorthSaying = 0.5;  // s
  const double lost = clock_.lost(system::suspended_seconds());
  if (std::exchange(stall_excused_, false) || stage_->transport.paused()) return;
  lost_time_ += lost;
  if (lost < kWorthSaying || std::exchange(stall_said_, true)) return;
  log_warning(
      "the show stood still for {:.1f} s: the program was stopped, or the machine was suspended or busy. This is not "
      "made "
      "up, and is said once; /transport/lost_time counts on",
      lost);
}

bool Engine::finished() const {
  if (replays() && !plays_ && player_->over()) return true;
  if (options_.strict && faults() > 0) return true;
  if (options_.ticks && stage_->world.tick() >= *options_.ticks) return true;
  return options_.duration && stage_->world.time() >= *options_.duration - 1e-9;
}

void Engine::stop() {
  {
    const std::scoped_lock lock(wake_mutex_);
    stop_.store(true);
  }
  wake_.notify_all();
}

void Engine::pass(bool may_step) {
  fixed::reset_arithmetic();
  Stopwatch watch;
  calls_.begin_tick();
  requests_.serve();
  if (plays_ && (link_.panic_signal.load() || link_.inbox.waits(UrgentKind::panic))) end_play();
  if (replays() && !next_of_take(may_step)) {
    if (!plays_) return;
    end_play();
  }
  rerun();
  age_panic(may_step);
  drain();
  times_.commands = watch.lap();

  Stage& stage = *stage_;
  const bool goes_on = may_step && (!stage.transport.paused() || stage.transport.take_step());
  const bool running = replays() ? may_step : goes_on;  // the take has it
  play(running);
  watch.lap();

  if (take_wanted_) {
    begin_take();
  } else {
    if (stage.world.take_reset_request()) reset();
    take_tick(running);
  }
  if (std::exchange(take_ends_, false)) {
    end_take();
    if (plays_) end_play();
  }
  tell_health();
  publish();
  make_image(asks_);
  if (was_paused_ != stage_->transport.paused()) send_transport();
  times_.snapshot = watch.lap();
  presets_.prepare(stage_->world);
  if (recovery_ != nullptr && !replays() && recovery_->asks()) give_recovery();
  if (stage_->scene != nullptr) stage_->scene->collect_garbage();
  end_pass(running);
  times_.collector = watch.lap();
}

// what the tick is made of once its commands are done
void Engine::play(bool running) {
  Stage& stage = *stage_;
  Stopwatch watch;
  end_panic();
  if (running) presets_.advance(stage.world);
  call_handlers();
  if (running && stage.scene != nullptr && !stage.world.panic().on()) stage.scene->tick(stage.world.timestep());
  carry_out_wishes();
  begin_panic();
  edits_.end(stage.store);
  if (!again_) notes_.tell(stage.store);
  times_.scripts = watch.lap();
  if (!running) return stage.world.settle();
  stage.dispatch.pull_grips();
  stage.world.step();
  const TickTimes& physics = stage.world.times();
  times_.behaviors = physics.behaviors;
  times_.effects = physics.effects;
  times_.physics = physics.physics;
  times_.readouts = physics.readouts;
  send_contacts();
}

void Engine::publish() {
  stage_->counters.tell();
  stage_->preset_node.tell();
  tell_transport();
  tell_take();
  stage_->publisher.publish(stage_->transport.paused(), clock_.speed_reached(), times_);
}

void Engine::make_image(std::uint64_t asks) {
  if (!images_.make(stage_->store, link_.snapshots.read(), asks)) return;
  link_.wake_network();
  link_.wake_query();
}

void Engine::drain() {
  stage_->dispatch.begin_tick();
  (void)stage_->transport.take_back();  // of the command line
  Hands hands(stage_->world, presets_, edits_, notes_);
  if (replays()) return replay_messages(hands);
  execute_urgent(hands);
  answer_questions(hands);
  const double begun = options_.clock();
  bool taken = false;
  for (int work = kTickWork; work > 0;) {
    if (next_command_ < commands_.size()) {
      Command& command = commands_[next_command_++];
      hands.begin(command.origin);
      for (Message& message : command.messages) {
        work--;
        if (overtaken(message, command.arrival) || waits_for_steps(message, command.origin)) continue;
        work -= execute(message, command.origin);
        if (std::exchange(went_back_, false)) hands.begin(command.origin);
      }
      if (command.evaluate == nullptr) continue;
      evaluate(*command.evaluate, command.origin);
      work -= kEvaluationWork;
      if (!options_.fast && options_.clock() - begun > kHandlerSeconds) break;
      continue;
    }
    asks_ = asks_of_batch_;
    if (std::exchange(taken, true)) break;
    asks_of_batch_ = link_.image_asks.load();  // an image holds whatever had come when it was asked for
    link_.inbox.drain(commands_);
    next_command_ = 0;
  }
}

// `params` that it sets are the performer's; in takes of before they were not
Evaluation Engine::evaluate_text(std::string_view text) {
  Scene& scene = *stage_->scene;
  const ConsoleParams set(stage_->store, scene.params());
  Evaluation said = scene.evaluate(text);
  if (!replays() || player_->keeps_timers()) set.remember(hand_);
  return said;
}

// what a person mistypes is answered to them and is no fault of the show
void Engine::evaluate(const Evaluate& wish, const Origin& origin) {
  Evaluation said{Evaluation::Kind::error, "there is no scene to evaluate in"};
  const std::uint64_t before = log_newest();
  if (wish.text.size() > kMostEvaluated) {
    said.text = fmt::format("a text for the scene has up to {} bytes, this one {}", kMostEvaluated, wish.text.size());
  } else if (stage_->scene != nullptr) {
    Scene& scene = *stage_->scene;
    if (wish.wish == Evaluate::Wish::run) {
      if (recorder_ != nullptr) recorder_->evaluation(wish.text, origin);
      history_.note({wish.text, {}}, origin, true);
    }
    said = wish.wish == Evaluate::Wish::run ? evaluate_text(wish.text) : scene.complete(wish.text);
  }
  said.log_before = before;
  said.log_after = log_newest();
  wish.answer(std::move(said));
}

int Engine::execute(Message& message, const Origin& origin) {
  Outcome outcome = stage_->dispatch.execute(message);
  const std::optional<Transport::Back> back = stage_->transport.take_back();
  if (back && !again_) {
    outcome = go_back(*back, origin);
    went_back_ = true;
  } else if (!again_) {
    if (recorder_ != nullptr) recorder_->message(message, origin);
    history_.note(message, origin);
  }
  if (outcome.kind == Outcome::Kind::takes && !again_) outcome = ask_take(message);
  if (outcome.kind == Outcome::Kind::scenes && (!link_.ask_scenes || again_)) outcome.kind = Outcome::Kind::refused;
  if (outcome.clamped != nullptr && !again_) {
    link_.counters.clamped.fetch_add(1, std::memory_order_relaxed);
    say_clamped(message, *outcome.clamped);
  }
  if (outcome.kept) hand_.remember(message);
  if (origin.follows && !again_ && outcome.kind == Outcome::Kind::applied) {
    for (const Dispatch::Write& write : stage_->dispatch.written())
      images_.note(stage_->store, origin, write.place, write.place.row == outcome.clamped);
  }
  if (!outcome.said.empty() && !again_) {
    say_left_out(outcome.said);
    refuse(message.address, origin, outcome.said);
  }
  for (Message& answer : outcome.answers) push_out({Outgoing::To::sender, origin, std::move(answer)});
  if (outcome.kind == Outcome::Kind::refused && !again_) {
    link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    faults_++;
    refuse(message.address, origin, outcome.error);
  }
  if (outcome.kind == Outcome::Kind::scenes) link_.ask_scenes(message, origin);
  const bool unknown = outcome.kind == Outcome::Kind::unknown;
  const bool listens = stage_->scene != nullptr && stage_->scene->listens();
  const bool applied = outcome.kind == Outcome::Kind::applied;
  const int work =
      static_cast<int>(stage_->dispatch.written().size()) + (applied ? 0 : kTextWork) + (listens ? kHeardWork : 0);
  // the scene's handlers hear it after every message of the tick took effect
  if (back) return work;
  if (listens) {
    const bool fits = heard_.push({std::move(message), origin, unknown, std::move(outcome.error)}, has_rules());
    if (!fits && !again_) link_.counters.unheard.fetch_add(1, std::memory_order_relaxed);
  } else if (unknown && !again_) {
    link_.counters.unknown.fetch_add(1, std::memory_order_relaxed);
    refuse(message.address, origin, outcome.error);
  }
  return work;
}

std::uint64_t Engine::state_hash() const {
  const std::uint64_t hash = stage_->world.state_hash();
  return stage_->scene == nullptr ? hash : stage_->scene->state_hash(hash);
}

void Engine::ask_reset() { stage_->world.ask_reset(); }

}  // namespace limber
