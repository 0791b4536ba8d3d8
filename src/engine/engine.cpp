// The simulation thread's loop.
#include "engine/engine.h"

#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kMaxRemembered = 65536;  // performer's values that outlive a reset

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// the time since the last call, onto `sum`
class Stopwatch {
 public:
  double lap() {
    const double now = seconds_now();
    return now - std::exchange(last_, now);
  }

 private:
  double last_ = seconds_now();
};

}  // namespace

Engine::Engine(EngineLink& link, EngineOptions options)
    : link_(link), options_(std::move(options)), world_(std::make_unique<World>(store_)) {
  dispatch_ = std::make_unique<Dispatch>(*world_);
  transport_ = std::make_unique<Transport>(*world_);
  counters_ = std::make_unique<CounterNode>(store_, link_.counters);
  publisher_ = std::make_unique<Publisher>(*world_, link_.snapshots);
  link_.wake_engine = [this] {
    {
      const std::scoped_lock lock(wake_mutex_);
      woken_ = true;
    }
    wake_.notify_one();
  };
}

Engine::~Engine() {
  link_.wake_engine = [] {};
}

Result<void> Engine::start() {
  if (const Result<void> ran = run_scene(); !ran) return ran;
  for (const Message& message : options_.sets) {
    const Outcome outcome = dispatch_->execute(message);
    const bool ok = outcome.kind == Outcome::Kind::applied;
    if (!ok)
      return Error{fmt::format("--set {}: {}", message.address,
                               outcome.kind == Outcome::Kind::answered ? "this is no value" : outcome.error)};
    if (outcome.clamped) log_warning("--set {}: the value is outside its range and was clamped", message.address);
    remember(message);
  }
  world_->settle();
  if (scene_ != nullptr) scene_->start();
  publisher_->publish(transport_->paused(), 1);
  return {};
}

Result<void> Engine::run_scene() {
  scene_ = nullptr;
  world_->clear();
  if (options_.scene.empty()) return {};
  scene_ = std::make_unique<Scene>(*world_, static_cast<ScriptHost&>(*this), options_.scene_options);
  return scene_->run(options_.scene);
}

void Engine::reset() {
  world_->restart_time();
  const Result<void> ran = run_scene();
  if (!ran) {
    faults_++;
    log_error("reset: {}", ran.error());
  }
  for (const Message& message : performer_) {
    if (!message.address.empty()) (void)dispatch_->execute(message);
  }
  world_->settle();
  if (scene_ != nullptr && ran) scene_->start();
}

void Engine::run() {
  clock_.restart(Clock::Time::clock::now());
  while (!stop_.load(std::memory_order_relaxed) && !finished()) {
    if (!options_.fast) wait_until(clock_.due());
    if (stop_.load(std::memory_order_relaxed)) break;
    tick();
    if (options_.fast && !transport_->paused()) continue;
    const auto now = Clock::Time::clock::now();
    const double speed = store_.values(world_->id(), World::table().at("speed"))[0];
    clock_.tick(now, world_->timestep(), speed);
    if (transport_->paused()) {
      if (options_.fast) wait_until(clock_.due());
      continue;
    }
    if (clock_.take_late()) {
      log_warning(
          "time runs at {:.2f} × real time: this machine can't keep up; fewer substeps or solver_iterations would help",
          clock_.speed_reached());
    }
  }
}

bool Engine::finished() const {
  if (options_.strict && faults() > 0) return true;
  if (options_.ticks && world_->tick() >= *options_.ticks) return true;
  return options_.duration && world_->time() >= *options_.duration - 1e-9;
}

void Engine::stop() {
  stop_.store(true);
  link_.wake_engine();
}

void Engine::wait_until(Clock::Time due) {
  std::unique_lock lock(wake_mutex_);
  wake_.wait_until(lock, due, [this] { return stop_.load(std::memory_order_relaxed); });
}

void Engine::tick() {
  Stopwatch watch;
  drain();
  times_.commands = watch.lap();

  const bool running = !transport_->paused() || transport_->take_step();
  call_handlers();
  if (running && scene_ != nullptr) scene_->tick(world_->timestep());
  times_.scripts = watch.lap();

  if (running) {
    world_->step();
  } else {
    world_->settle();
  }
  const TickTimes& physics = world_->times();
  times_.effects = physics.effects;
  times_.physics = physics.physics;
  times_.readouts = physics.readouts;
  watch.lap();

  if (world_->take_reset_request()) reset();
  counters_->tell();
  transport_->tell(options_.fast ? 1 : clock_.speed_reached());
  publisher_->publish(transport_->paused(), clock_.speed_reached());
  if (running) send_events();
  if (was_paused_ != transport_->paused()) {
    was_paused_ = transport_->paused();
    push_out({Outgoing::To::event,
              {},
              {"/transport/state",
               {Arg::of(was_paused_), Arg::of(static_cast<double>(world_->tick())), Arg::of(world_->time()),
                Arg::of(clock_.speed_reached())}}});
  }
  times_.snapshot = watch.lap();
  if (scene_ != nullptr) scene_->collect_garbage();
  times_.collector = watch.lap();
}

void Engine::drain() {
  heard_.clear();
  link_.inbox.drain(commands_);
  for (Command& command : commands_) {
    for (Message& message : command.messages) execute(message, command.origin);
  }
}

void Engine::execute(const Message& message, const Origin& origin) {
  Outcome outcome = dispatch_->execute(message);
  if (outcome.clamped) link_.counters.clamped.fetch_add(1, std::memory_order_relaxed);
  if (outcome.kind == Outcome::Kind::applied && outcome.kept) remember(message);
  for (Message& answer : outcome.answers) push_out({Outgoing::To::sender, origin, std::move(answer)});
  if (outcome.kind == Outcome::Kind::refused) {
    link_.counters.refused.fetch_add(1, std::memory_order_relaxed);
    faults_++;
    push_out({Outgoing::To::error, origin, {"/error", {Arg::of(message.address), Arg::of(outcome.error)}}});
  }
  // the scene's handlers hear it after every message of the tick took effect
  if (scene_ != nullptr && scene_->listens()) {
    heard_.push_back({message, origin, std::move(outcome)});
  } else if (outcome.kind == Outcome::Kind::unknown) {
    link_.counters.unknown.fetch_add(1, std::memory_order_relaxed);
    push_out({Outgoing::To::error, origin, {"/error", {Arg::of(message.address), Arg::of(outcome.error)}}});
  }
}

void Engine::call_handlers() {
  for (Heard& heard : heard_) {
    const bool answered = scene_->message(heard.message, heard.origin);
    if (answered || heard.outcome.kind != Outcome::Kind::unknown) continue;
    link_.counters.unknown.fetch_add(1, std::memory_order_relaxed);
    push_out({Outgoing::To::error,
              heard.origin,
              {"/error", {Arg::of(heard.message.address), Arg::of(heard.outcome.error)}}});
  }
  heard_.clear();
}

void Engine::remember(const Message& message) {
  // the key: the address and the names; the newest value moves to the end, since the last one wins
  std::string key = plain_name(message.address);
  for (const Arg& arg : message.args) {
    if (!arg.is_text()) break;
    key += '\n';
    key += arg.text;
  }
  const auto known = performer_at_.find(key);
  if (known != performer_at_.end()) {
    performer_[known->second].address.clear();  // its place is empty now
    known->second = performer_.size();
  } else if (performer_at_.size() < kMaxRemembered) {
    performer_at_.emplace(std::move(key), performer_.size());
  } else {
    return;
  }
  performer_.push_back(message);
  if (performer_.size() > 2 * performer_at_.size() + 64) forget_empty_places();
}

void Engine::forget_empty_places() {
  std::vector<std::size_t> moved(performer_.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < performer_.size(); i++) {
    moved[i] = count;
    if (!performer_[i].address.empty()) count++;
  }
  std::erase_if(performer_, [](const Message& m) { return m.address.empty(); });
  for (auto& [key, place] : performer_at_) place = moved[place];
}

void Engine::send_events() {
  for (const ContactEvent& contact : world_->contacts()) {
    if (!store_.alive(contact.part) || !store_.alive(contact.other)) continue;
    const auto* part = static_cast<const Part*>(store_.thing(contact.part));
    const auto* other = static_cast<const Part*>(store_.thing(contact.other));
    push_out({Outgoing::To::event,
              {},
              {"/physics/contact",
               {Arg::of(part->body().name()), Arg::of(part->name()), Arg::of(other->body().name()),
                Arg::of(other->name()), Arg::of(contact.impulse), Arg::of(contact.position.x),
                Arg::of(contact.position.y), Arg::of(contact.position.z)}}});
  }
}

void Engine::push_out(Outgoing out) {
  link_.outbox.push(std::move(out));
  link_.wake_network();
}

std::uint64_t Engine::state_hash() const {
  const std::uint64_t hash = world_->state_hash();
  return scene_ == nullptr ? hash : scene_->state_hash(hash);
}

void Engine::send(Message message) { push_out({Outgoing::To::targets, {}, std::move(message)}); }
void Engine::reply(const Origin& to, Message message) { push_out({Outgoing::To::sender, to, std::move(message)}); }
void Engine::send_direct(const Origin& to, Message message) {
  push_out({Outgoing::To::direct, to, std::move(message)});
}

void Engine::plan_osc(const OscPlan& plan) {
  const std::shared_ptr<OscPlan> planned = link_.osc_plan.spare();
  *planned = plan;
  link_.osc_plan.publish(planned);
  link_.wake_network();
}

void Engine::ask_reset() { world_->ask_reset(); }

void Engine::script_error(std::string_view file, int line, std::string_view text) {
  if (text.empty()) {
    push_out({Outgoing::To::event, {}, {"/script/ok", {Arg::of(file)}}});
    return;
  }
  faults_++;
  log_error("{}", text);
  push_out(
      {Outgoing::To::event, {}, {"/script/error", {Arg::of(file), Arg::of(static_cast<double>(line)), Arg::of(text)}}});
}

}  // namespace limber
