// Engine: time that goes back.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "engine/engine.h"

namespace limber {

namespace {
constexpr std::size_t kMostBytesOfReplay = std::size_t{1} << 30;  // it must get as far as the show did
}  // namespace

void Engine::end_pass(bool running) {
  if (replays()) history_.allow(kMostBytesOfReplay);
  history_.end_pass(*stage_, calls_, running, stage_->world_value("history"));
}

void Engine::tell_transport() {
  const double rewindable = history_.empty() ? 0 : stage_->world.time() - history_.oldest_time();
  stage_->transport.tell(clock_.speed_reached(), rewindable, static_cast<double>(history_.bytes()) / (1u << 20u),
                         lost_time_);
}

// Everything is as it was then; what of this tick was done before goes with the rest, what comes after it is done
// there.
Outcome Engine::go_back(const Transport::Back& back, const Origin& origin) {
  stall_excused_ = true;
  World& world = stage_->world;
  const std::uint64_t tick = world.tick();
  const double time = world.time();
  if (!history_.fits(*stage_) || tick <= history_.oldest_tick()) {
    return Outcome::refused(fmt::format("time can't go back: {}", history_.why()));
  }
  PastGoal goal;
  if (back.ticks > 0) {
    goal.tick = back.ticks < tick ? tick - back.ticks : 0;
  } else {
    goal.time = time - back.seconds;
  }
  std::string short_of;
  const bool too_far =
      goal.time ? *goal.time < history_.oldest_time() - world.timestep() / 2 : goal.tick < history_.oldest_tick();
  if (too_far) {
    goal = {history_.oldest_tick(), {}};
    short_of = history_.why();
  }
  if (goal.time && *goal.time > time - world.timestep() / 2) goal = {tick - 1, {}};  // less than half a tick: one
  do_again_until(goal);
  if (back.stands) stage_->transport.stand_still();
  Outcome outcome;
  outcome.kind = Outcome::Kind::answered;
  Message& said = outcome.answers.emplace_back(Message{"/transport/rewound", {}});
  said.args = {Arg::of(std::round(1e6 * (time - world.time())) / 1e6), Arg::of(static_cast<double>(world.tick()))};
  if (!short_of.empty()) said.args.push_back(Arg::of(short_of));
  if (recorder_ != nullptr) {
    // as far as it went: a replay may have kept more, or less
    if (back.stands) recorder_->message({"/transport/pause", {}}, origin);
    recorder_->message({"/transport/rewind_ticks", {Arg::of(static_cast<double>(tick - world.tick()))}}, origin);
  }
  send_transport();
  return outcome;
}

void Engine::do_again_until(const PastGoal& goal) {
  // what belongs to the hour; and presets, which nobody wants to lose
  constexpr std::array<const char*, 3> kOfTheHour = {"paused", "speed", "history"};
  std::array<double, kOfTheHour.size()> of_the_hour{};
  for (std::size_t i = 0; i < kOfTheHour.size(); i++) of_the_hour[i] = stage_->world_value(kOfTheHour[i]);
  const int steps = stage_->transport.steps();
  PresetList presets = presets_.list();
  const CallLedger calls = calls_;
  Store& store = stage_->store;
  const Store::Listener hands = store.listen({});
  heard_.clear();
  wishes_.clear();
  history_.bring_back(*stage_, goal);
  begin_again(true);
  bool there = false;
  bool stopped = false;  // a call that was good then: what follows would differ more and more, and take long
  for (PastPass pass; !there && !stopped && history_.next(pass);) {
    there = pass.running && goal.reached(stage_->world);
    if (there) continue;
    do_again(pass);
    stopped = calls_.unforeseen() > 0;
  }
  history_.cut(there);
  begin_again(false);
  if (stopped) log_warning("rewind: a script computes too long in what is repeated; time went back further than asked");
  hears_.reset();
  presets_.take_list(std::move(presets));
  for (std::size_t i = 0; i < kOfTheHour.size(); i++)
    (void)store.set(stage_->world.id(), kOfTheHour[i], {&of_the_hour[i], 1});
  stage_->transport.keep_steps(steps);
  calls_ = calls;
  calls_.note_rewind();
  store.listen(hands);
  stage_->dispatch.begin_tick();
}

// nothing of what was said, sent or stored once is said, sent or stored again
void Engine::begin_again(bool on) {
  again_ = on;
  silence_.reset();
  if (on) silence_.emplace();
  presets_.do_again(on);
  if (stage_->scene != nullptr) stage_->scene->do_again(on);
}

void Engine::do_again(PastPass& pass) {
  calls_.begin_tick(std::move(pass.stopped));
  stage_->dispatch.begin_tick();
  {
    Hands hands(stage_->world, presets_, edits_, quiet_notes_);
    hears_.reset();
    for (TakeMessage& input : pass.messages) {
      if (!input.evaluate && carry_out_event(input.message)) continue;
      hands.begin(input.origin);
      if (!input.evaluate) {
        execute(input.message, input.origin);
      } else if (stage_->scene != nullptr) {
        (void)evaluate_text(input.message.address);
      }
    }
  }
  play(pass.running);
  (void)stage_->world.take_reset_request();  // it failed then
  stage_->preset_node.tell();
  if (stage_->scene != nullptr) stage_->scene->collect_garbage();
}

bool Engine::return_before(std::uint64_t tick) {
  const PresetList presets = presets_.list();
  if (!history_.fits(*stage_) || !history_.return_before(*stage_, tick)) return false;
  presets_.take_list(presets);
  heard_.clear();
  wishes_.clear();
  calls_.note_rewind();
  went_back_ = true;
  return true;
}

}  // namespace limber
