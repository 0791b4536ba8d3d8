// LiveInput: urgent requests, commands, rejections during a replay, and decisions that depend on real time.
#include "engine/input/live_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"

namespace limber::engine {

namespace {
// Costs in units of LiveInput::kPassWork: a console evaluation, a rejected message.
constexpr int kEvaluationWork = 512;
constexpr int kRejectionWork = 8;
}  // namespace

void HandlerBudget::begin(double now) {
  const double elapsed = std::max(now - std::exchange(begun_, now), 0.0);
  seconds_ = std::min(seconds_ + kShare * elapsed, kMaxSeconds);
}

bool PanicTimer::update(const sim::Panic& panic, double now, std::optional<double> step) {
  const double elapsed = now - std::exchange(last_update_, now);
  if (!panic.on() || panic.first_second_over()) {
    age_ = 0;
    return false;
  }
  age_ += step.value_or(elapsed);
  return age_ >= kSeconds - 1e-9;
}

void PanicTimer::restart(double now) {
  age_ = 0;
  last_update_ = now;
}

void StepRequests::add(const CommandOrigin& origin) {
  if (origins_.size() < kMax) origins_.push_back(origin);
}

bool StepRequests::postpone(const Message& message, const CommandOrigin& origin) {
  if (origins_.empty() || queries_.size() >= kMaxQueries || !same_address(message.address, "/get")) return false;
  if (std::ranges::find(origins_, origin) == origins_.end()) return false;
  queries_.push_back({message, origin});
  return true;
}

void StepRequests::finish(const std::function<void(const CommandOrigin&)>& answer) {
  for (const CommandOrigin& origin : origins_) answer(origin);
  origins_.clear();
}

void LiveInput::execute_messages(bool may_step) {
  update_panic_timer(may_step);
  EditScope edit_scope = show_.edit_scope();
  execute_urgent(edit_scope);
  if (show_.session->transport.steps() == 0) {
    for (StepRequests::Query& query : step_requests_.consume_queries()) {
      edit_scope.begin(query.origin);
      executor_.execute(query.message, query.origin, *this);
    }
  }
  const double start_time = show_.options.clock();
  bool drained = false;
  for (int work = kPassWork; work > 0;) {
    if (waits_for_ticks()) break;
    if (next_command_ < commands_.size()) {
      Command& command = commands_[next_command_++];
      work -= execute(command, edit_scope);
      const bool slow = command.evaluation != nullptr && show_.options.in_real_time() &&
                        show_.options.clock() - start_time > HandlerBudget::kMaxSeconds;
      if (slow) break;
      continue;
    }
    snapshot_requests_ = snapshot_requests_of_batch_;
    if (std::exchange(drained, true)) break;
    // before the queue is drained, because a value snapshot must contain all commands that came before its request
    snapshot_requests_of_batch_ = show_.link.value_snapshot_requests.load();
    show_.link.command_queue.drain(commands_);
    next_command_ = 0;
  }
  // after the messages, which may have requested the tick
  cues_.run_due(may_step, edit_scope, *this);
}

// Measures the age of a panic in real time, or with --fast and --lockstep in simulated time, so that equal runs have
// equal results. With --lockstep, the number of passes depends on real time, so the time of the world counts.
void LiveInput::update_panic_timer(bool may_step) {
  sim::World& world = show_.session->world;
  std::optional<double> step;
  if (show_.options.fast) step = may_step ? world.timestep() : 0;
  if (!panic_timer_.update(world.panic(), show_.options.lockstep ? world.time() : show_.options.clock(), step)) return;
  world.panic().end_first_second();
  record_event({TakeEvent::Kind::panic_settled, 0});
}

// Executes urgent requests ahead of all queued commands.
void LiveInput::execute_urgent(EditScope& edit_scope) {
  EngineLink& link = show_.link;
  link.command_queue.drain_urgent(urgent_);
  link.counters.discarded.fetch_add(link.command_queue.fetch_discarded(), std::memory_order_relaxed);
  if (link.panic_signal.exchange(false))
    urgent_.push_back({UrgentKind::panic,
                       {"/transport/panic", {}},
                       {CommandSource::command_line},
                       link.command_queue.next_arrival()});
  for (UrgentRequest& request : urgent_) {
    urgent_precedence_.record(request);
    if (request.kind == UrgentKind::panic && !show_.session->world.panic().on()) link.panics.fetch_add(1);
    if (request.kind == UrgentKind::take_stop) link.take_stops.fetch_add(1);
    edit_scope.begin(request.origin);
    executor_.execute(request.message, request.origin, *this);
  }
}

// Executes the messages and the evaluation of a command; returns their work.
int LiveInput::execute(Command& command, EditScope& edit_scope) {
  int work = 0;
  edit_scope.begin(command.origin);
  for (Message& message : command.messages) {
    work++;
    const bool is_step = same_address(message.address, "/transport/step");
    if (discard_if_overtaken(message, command.arrival)) {
      if (is_step) step_requests_.add(command.origin);
      continue;
    }
    if (step_requests_.postpone(message, command.origin)) continue;
    if (same_address(message.address, "/clock/sync")) correct_beat(message);
    const CommandExecutor::Execution execution = executor_.execute(message, command.origin, *this);
    work += execution.work + cues_.run_requested(*this);
    if (execution.applied && is_step) step_requests_.add(command.origin);
    if (execution.rewound) edit_scope.begin(command.origin);  // the undo stack was restored
  }
  if (command.evaluation == nullptr) return work;
  executor_.evaluate(*command.evaluation, command.origin, *this);
  return work + kEvaluationWork;
}

// Clocks of this machine send, as a third value, when their beat was (s, by the steady clock): the beat becomes that of
// this pass, so that the time in the queue makes no difference.
void LiveInput::correct_beat(Message& message) const {
  std::vector<Arg>& args = message.args;
  if (args.size() != 3 || !std::ranges::all_of(args, &Arg::is_numeric)) return;
  const double age = show_.options.clock() - args[2].number;
  if (show_.options.in_real_time() && std::abs(age) < 1) args[0] = Arg::of(args[0].number + age * args[1].number / 60);
  args.pop_back();
}

bool LiveInput::discard_if_overtaken(const Message& message, std::uint64_t arrival) {
  if (!urgent_precedence_.discards(message, arrival)) return false;
  show_.link.counters.discarded.fetch_add(1, std::memory_order_relaxed);
  return true;
}

bool LiveInput::advances_time(bool may_step) {
  Transport& transport = show_.session->transport;
  return may_step && (!transport.paused() || transport.consume_step());
}

// With --lockstep, messages that the last pass left are executed at once.
bool LiveInput::is_paced() const {
  if (show_.options.lockstep) return !waits_for_ticks() && next_command_ >= commands_.size();
  return !show_.options.fast || show_.session->transport.paused();
}

// Answers requests for ticks that are finished, or were canceled by a pause.
void LiveInput::end_pass() {
  if (show_.session->transport.steps() > 0) return;
  step_requests_.finish([&](const CommandOrigin& origin) {
    if (origin.source == CommandSource::panel) return;
    const auto tick = static_cast<double>(show_.session->world.tick());
    show_.output().push({Outgoing::Destination::reply, origin, {"/transport/stepped", {Arg::of(tick)}}});
  });
}

void LiveInput::begin_handlers() { handler_budget_.begin(show_.options.clock()); }

// Outside of real time there is no limit.
bool LiveInput::may_call_handler(std::uint64_t) const {
  return !show_.options.in_real_time() || !handler_budget_.exceeded(show_.options.clock());
}

// The number of calls depends on real time, so it is recorded as an input if messages wait for the next pass.
void LiveInput::end_handlers(std::uint64_t called) {
  handler_budget_.end(show_.options.clock());
  if (!show_.handler_queue.empty()) record_event({TakeEvent::Kind::messages_handled, called});
}

void LiveInput::record(const Message& message, const CommandOrigin& origin, bool evaluate) {
  recording_.record(message, origin, evaluate);
  show_.history.record_input(message, origin, evaluate);
}

void LiveInput::record_event(const TakeEvent& event) { record(message_of(event), {}, false); }

// Records the ticks that were actually rewound: the history of a replay may reach back further, or less far.
Outcome LiveInput::rewind(const Transport::RewindRequest& request, const CommandOrigin& origin) {
  const sim::World& world = show_.session->world;
  const std::uint64_t tick = world.tick();
  Outcome outcome = rewinder_.rewind(request);
  if (outcome.kind == Outcome::Kind::rejected) return outcome;
  if (request.pause) recording_.record({"/transport/pause", {}}, origin, false);
  recording_.record({"/transport/rewind_ticks", {Arg::of(static_cast<double>(tick - world.tick()))}}, origin, false);
  return outcome;
}

Outcome LiveInput::request_midi(const Message& message, const CommandOrigin& origin) {
  if (!show_.link.on_midi_request)
    return Outcome::rejected("MIDI is off; start limber without --midi off, and in real time");
  show_.link.on_midi_request(message, origin);
  return {};
}

Outcome LiveInput::request_osc(const Message& message, const CommandOrigin& origin) {
  if (!show_.link.on_osc_request) return Outcome::rejected("OSC is off; it needs a show that plays in real time");
  const Result<void> accepted = show_.link.on_osc_request(message, origin);
  return accepted ? Outcome{} : Outcome::rejected(accepted.error());
}

bool LiveInput::must_rerun() {
  if (!show_.link.on_rerun || !show_.options.in_real_time()) return true;
  show_.link.on_rerun();
  return false;
}

void LiveInput::reject_messages(const char* reason, bool* stop) {
  panic_timer_.restart(show_.options.clock());
  reject_urgent(reason, stop);
  if (next_command_ >= commands_.size()) {
    show_.link.command_queue.drain(commands_);
    next_command_ = 0;
  }
  reject_commands(reason, stop);
}

void LiveInput::reject_commands(const char* reason, bool* stop) {
  for (int work = kPassWork; work > 0 && next_command_ < commands_.size(); next_command_++) {
    const Command& command = commands_[next_command_];
    for (const Message& message : command.messages) reject(message, command.origin, reason, stop);
    if (command.evaluation != nullptr) command.evaluation->on_result({Evaluation::Kind::error, reason, 0, 0, 0});
    work -= kRejectionWork * static_cast<int>(1 + command.messages.size());
  }
  snapshot_requests_ = show_.link.value_snapshot_requests.load();
}

void LiveInput::reject_urgent(const char* reason, bool* stop) {
  EngineLink& link = show_.link;
  link.command_queue.drain_urgent(urgent_);
  for (const UrgentRequest& request : urgent_) {
    urgent_precedence_.record(request);
    // a panic stops playback in the next pass, and is executed then
    if (stop != nullptr && request.kind == UrgentKind::panic) {
      link.command_queue.push_urgent(request);
      continue;
    }
    if (request.kind == UrgentKind::take_stop) link.take_stops.fetch_add(1);
    reject(request.message, request.origin, reason, stop);
  }
}

void LiveInput::reject(const Message& message, const CommandOrigin& origin, const char* reason, bool* stop) {
  const std::string address = normalized_name(message.address);
  Outcome outcome = Outcome::rejected(reason);
  if (stop != nullptr && address == "/take/stop") {
    *stop = true;
    outcome = Outcome::answered();
    outcome.answers.push_back({"/take/stopped", {}});
  } else if (address == "/get" || address.starts_with("/list/")) {
    outcome = show_.session->dispatcher.execute(message);
  }
  Output& output = show_.output();
  for (Message& answer : outcome.answers) output.push({Outgoing::Destination::reply, origin, std::move(answer)});
  if (outcome.kind == Outcome::Kind::scene_request && output.accepts_scene_requests())
    return output.request_scene(message, origin);
  if (outcome.kind != Outcome::Kind::answered)
    output.push({Outgoing::Destination::error, origin, error_message(message.address, outcome.error)});
}

}  // namespace limber::engine
