// Key states and what lies between them: taken, found, brought back, let go.
#include "engine/history.h"

#include <algorithm>
#include <utility>

#include "base/log.h"

namespace limber {

namespace {

enum class Record : std::uint8_t { input, stop, rested, ran };

constexpr std::size_t kMostInputs = std::size_t{4} << 20;  // bytes behind one key state
constexpr std::uint64_t kStopsApart = 15;  // ticks: a call that is stopped again and again costs no more than that

}  // namespace

std::size_t History::bytes() const {
  std::size_t all = pages_.bytes();
  const Edits::Memory* edits = nullptr;
  for (const auto& key : keys_) {
    all += const_cast<KeyBytes&>(key->inputs).bytes().capacity() + key->heard.bytes();
    if (key->edits.get() != edits) all += key->edits->size();
    edits = key->edits.get();
  }
  return all;
}

void History::begin_anew(std::string_view why) {
  while (!keys_.empty()) drop(keys_.size() - 1);
  if (held_ != nullptr) forget(std::move(held_));
  hold_ = kNoTick;
  why_ = why;
  too_large_ = false;
}

// a key state lists things in their order, so it fits only the structure from which it was taken
bool History::fits(const Stage& stage) {
  const std::uint64_t structure = stage.store.structure_version();
  if (std::exchange(structure_, structure) != structure && !keys_.empty()) begin_anew("things came or went");
  return !keys_.empty();
}

void History::drop(std::size_t number) {
  std::unique_ptr<Key> key = std::move(keys_[number]);
  keys_.erase(keys_.begin() + static_cast<std::ptrdiff_t>(number));
  forget(std::move(key));
}

void History::forget(std::unique_ptr<Key> key) {
  key->world.release(pages_);
  key->scene.release(pages_);
  key->heard.clear();
  key->inputs.go_on_taking(0);
  spare_.push_back(std::move(key));
}

void History::let_go_oldest() {
  if (keys_.front()->tick != hold_) return drop(0);
  held_ = std::move(keys_.front());
  held_->inputs.go_on_taking(0);
  keys_.erase(keys_.begin());
}

void History::hold() {
  if (held_ != nullptr) forget(std::move(held_));
  hold_ = keys_.empty() ? kNoTick : keys_.back()->tick;
}

void History::note(const Message& message, const Origin& origin, bool evaluate) {
  if (keys_.empty()) return;
  input_.message = message;
  input_.origin = origin;
  input_.evaluate = evaluate;
  KeyBytes& inputs = keys_.back()->inputs;
  auto record = Record::input;
  inputs.pass(record);
  pass_input(inputs, input_);
}

void History::pass_input(KeyBytes& bytes, TakeMessage& input) {
  bytes.pass_all(input.evaluate, input.origin, input.message.address);
  std::size_t count = input.message.args.size();
  bytes.pass(count);
  input.message.args.resize(count);
  for (Arg& arg : input.message.args) bytes.pass_all(arg.kind, arg.number, arg.text);
}

void History::pass_stop(KeyBytes& bytes, StoppedCall& stop) {
  bytes.pass_all(stop.number, stop.file, stop.line, stop.text);
}

void History::end_pass(Stage& stage, const CallLedger& calls, bool running, double seconds) {
  if (seconds <= 0) {
    if (!keys_.empty()) begin_anew("history is switched off");
    why_ = "history is switched off";
    spare_.clear();
    if (pages_.bytes() == 0) pages_.clear();
    release_runs(stage);
    return;
  }
  if (fits(stage)) {
    KeyBytes& inputs = keys_.back()->inputs;
    for (const StoppedCall& stop : calls.stopped_since_rewind()) {
      auto record = Record::stop;
      inputs.pass(record);
      stop_ = stop;
      pass_stop(inputs, stop_);
    }
    const bool empty = inputs.bytes().size() == pass_begins_;
    if (running || !empty) {
      auto record = running ? Record::ran : Record::rested;
      inputs.pass(record);
    }
    pass_begins_ = inputs.bytes().size();
  }
  if (due(stage.world, !calls.stopped().empty())) take(stage);
  trim(stage.world, seconds);
  release_runs(stage);
}

// runs of the scene whose last timer had ended before the oldest state
void History::release_runs(Stage& stage) const {
  if (stage.scene == nullptr) return;
  stage.scene->release_ended(held_ != nullptr ? held_->tick : empty() ? kNoTick : oldest_tick());
}

bool History::due(const World& world, bool stopped) const {
  if (too_large_) return false;
  const bool apart = world.time() >= last_time_ + kApart - 1e-9 || world.tick() < last_tick_;
  if (keys_.empty()) return apart || last_tick_ == 0;
  if (apart) return true;
  // what a call had changed in Lua before it was stopped is in no list of inputs
  if (stopped && world.tick() >= last_tick_ + kStopsApart) return true;
  return pass_begins_ > kMostInputs;
}

void History::take(Stage& stage) {
  if (spare_.empty()) spare_.push_back(std::make_unique<Key>());
  std::unique_ptr<Key> key = std::move(spare_.back());
  spare_.pop_back();
  const Key* const before = keys_.empty() ? nullptr : keys_.back().get();
  key->tick = last_tick_ = stage.world.tick();
  key->time = last_time_ = stage.world.time();
  key->world.take(stage.world, pages_, before == nullptr ? nullptr : &before->world, scratch_);
  key->has_scene = stage.scene != nullptr;
  if (key->has_scene) key->scene.take(*stage.scene, pages_, before == nullptr ? nullptr : &before->scene, scratch_);
  if (const std::uint64_t now = hand_.version(); known_hand_.copy == nullptr || known_hand_.version != now)
    known_hand_ = {std::make_shared<const PerformerHand>(hand_), now};
  if (const std::uint64_t now = edits_.version(); known_edits_.copy == nullptr || known_edits_.version != now)
    known_edits_ = {edits_.memory(), now};
  key->hand = known_hand_.copy;
  key->edits = known_edits_.copy;
  presets_.keep(key->presets);
  key->grips = stage.dispatch.grips();
  key->heard = heard_;
  key->inputs.begin_taking();
  pass_begins_ = 0;
  keys_.push_back(std::move(key));
}

void History::trim(const World& world, double seconds) {
  while (keys_.size() > 1 && keys_[1]->time <= world.time() - seconds + 1e-9) {
    let_go_oldest();
    why_ = "that is as much as is kept";
  }
  bool short_of_room = false;
  while (keys_.size() > 1 && bytes() > most_) {
    let_go_oldest();
    short_of_room = true;
    why_ = "more does not fit into 256 MB";
  }
  if (keys_.size() == 1 && bytes() > most_) {
    begin_anew("a state of this scene takes more than 256 MB");
    too_large_ = short_of_room = true;
  }
  if (!short_of_room || std::exchange(said_short_, true)) return;
  log_info("history: {:.0f} s of the past can be kept instead of {:.0f}: {} (said once)",
           keys_.empty() ? 0 : world.time() - oldest_time(), seconds, why_);
}

void History::restore(Stage& stage, std::size_t number) {
  while (keys_.size() > number + 1) drop(keys_.size() - 1);
  Key& key = *keys_[number];
  key.world.bring_back(stage.world, pages_, scratch_);
  if (key.has_scene) key.scene.bring_back(*stage.scene, pages_, scratch_);
  hand_.bring_back(*key.hand);
  edits_.bring_back(*key.edits);
  presets_.bring_back(key.presets);
  known_hand_ = {key.hand, hand_.version()};
  known_edits_ = {key.edits, edits_.version()};
  stage.dispatch.grips() = key.grips;
  heard_ = key.heard;
  last_tick_ = key.tick;
  last_time_ = key.time;
  key.inputs.begin_bringing();
  given_from_ = 0;
}

void History::bring_back(Stage& stage, const PastGoal& goal) {
  const double half = stage.world.timestep() / 2;
  std::size_t number = keys_.size();
  while (--number > 0) {
    const Key& key = *keys_[number];
    if (goal.time ? key.time <= *goal.time + half : key.tick <= goal.tick) break;
  }
  // inputs of this pass, so far, are of the future that goes
  keys_.back()->inputs.go_on_taking(pass_begins_);
  restore(stage, number);
}

bool History::next(PastPass& pass) {
  KeyBytes& inputs = keys_.back()->inputs;
  pass.messages.clear();
  pass.stopped.clear();
  given_from_ = inputs.at();
  while (inputs.at() < inputs.bytes().size()) {
    auto record = Record::input;
    inputs.pass(record);
    if (record == Record::input) {
      pass_input(inputs, pass.messages.emplace_back());
    } else if (record == Record::stop) {
      pass_stop(inputs, pass.stopped.emplace_back());
    } else {
      pass.running = record == Record::ran;
      return true;
    }
  }
  return false;
}

void History::cut(bool last) {
  KeyBytes& inputs = keys_.back()->inputs;
  pass_begins_ = last ? given_from_ : inputs.at();
  inputs.go_on_taking(pass_begins_);
}

bool History::return_before(Stage& stage, std::uint64_t tick) {
  std::size_t number = keys_.size();
  while (number > 0 && keys_[number - 1]->tick >= tick) number--;
  if (number == 0) {
    if (held_ == nullptr || held_->tick >= tick) return false;
    keys_.insert(keys_.begin(), std::move(held_));
    number = 1;
  }
  restore(stage, number - 1);
  cut();
  return true;
}

}  // namespace limber
