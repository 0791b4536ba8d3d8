// A step keeps the values that its rows do not have; undoing it and doing it again are the same exchange.
#include "engine/edits.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "params/catalog.h"

namespace limber {

bool Edits::Open::has(NodeId id, const Row& row) const {
  if (id.slot >= rows.size()) return false;
  const Rows& of = rows[id.slot];
  return of.step == number && of.generation == id.generation && (of.rows >> row.index & 1u) != 0;
}

// false: it has it already
bool Edits::Open::take(NodeId id, const Row& row) {
  if (has(id, row)) return false;
  if (id.slot >= rows.size()) rows.resize(id.slot + 1);
  Rows& of = rows[id.slot];
  if (of.step != number || of.generation != id.generation) of = {id.generation, number, 0};
  of.rows |= std::uint64_t{1} << row.index;
  return true;
}

void Edits::begin(const Origin& who, const World& world) {
  static const Row& paused = World::table().at("paused");
  who_ = who;
  time_ = world.time();
  running_ = world.store().values(world.id(), paused)[0] == 0;
  structure_ = world.store().structure_version();
  now_ = nullptr;
  hand_.note_in(nullptr);
}

void Edits::heard(const Store& store, NodeId id, const Row& row, bool later, const double* before) {
  // what comes with a thing that was made in this call goes with the thing
  if (quiet_ || row.kind != RowKind::property || store.born(id) > structure_) return;
  version_++;
  if (now_ == nullptr) now_ = &open_for(id, row);
  Step& step = *now_->step;
  hand_.note_in(&step.hand);
  step.pass = pass_;
  step.time = time_;
  step.later = step.later || later;
  if (!now_->take(id, row)) return;
  if (step.edits.size() >= step.look_at) forget_gone(step, store);
  step.edits.push_back({id, &row, step.values.size()});
  step.values.insert(step.values.end(), before, before + row.width);
  values_ += row.width;
}

// What has gone can't be undone. A hand that never pauses goes on with one step, which would gather all that ever came.
void Edits::forget_gone(Step& step, const Store& store) {
  std::size_t values = 0;
  std::size_t edits = 0;
  for (Edit edit : step.edits) {
    if (!store.alive(edit.id)) continue;
    std::copy_n(&step.values[edit.at], edit.row->width, &step.values[values]);
    edit.at = std::exchange(values, values + edit.row->width);
    step.edits[edits++] = edit;
  }
  values_ -= step.values.size() - values;
  step.values.resize(values);
  step.edits.resize(edits);
  step.look_at = std::max(step.look_at, 2 * step.edits.size());
}

// the step of this hand that goes on, or a new one
Edits::Open& Edits::open_for(NodeId id, const Row& row) {
  for (Open& open : open_) {
    if (open.step == nullptr || !(open.step->who == who_) || time_ - open.step->time > kGesture) continue;
    if (open.step->pass != pass_ && !open.has(id, row)) continue;
    open.used = ++uses_;
    return open;
  }
  return open_new();
}

Edits::Open& Edits::open_new() {
  done_.push_back(std::make_unique<Step>());
  done_.back()->who = who_;
  Open& open = *std::min_element(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
    return std::pair(a.step != nullptr, a.used) < std::pair(b.step != nullptr, b.used);
  });
  open.step = done_.back().get();
  open.number = open.used = ++uses_;
  return open;
}

bool Edits::differs(const Step& step, const Store& store) {
  return std::any_of(step.edits.begin(), step.edits.end(), [&](const Edit& edit) {
    return store.alive(edit.id) &&
           std::memcmp(store.values(edit.id, *edit.row), &step.values[edit.at], edit.row->width * sizeof(double)) != 0;
  });
}

void Edits::end(const Store& store) {
  pass_++;
  settle(store);
}

void Edits::settle(const Store& store) {
  now_ = nullptr;
  hand_.note_in(nullptr);
  bool settled = false;
  for (std::size_t i = done_.size(); i > 0 && !done_[i - 1]->settled; i--) {
    if (done_[i - 1]->later || differs(*done_[i - 1], store)) {
      settled = done_[i - 1]->settled = true;
      continue;
    }
    drop(done_[i - 1].get());
    done_.erase(done_.begin() + static_cast<std::ptrdiff_t>(i) - 1);
  }
  // what was undone before another step can't be done again
  if (settled) {
    for (const auto& step : undone_) drop(step.get());
    undone_.clear();
    trim();
    told_ = false;
  }
  if (!std::exchange(told_, true)) tell_texts(store);
}

void Edits::drop(const Step* step) {
  values_ -= step->values.size();
  for (Open& open : open_) {
    if (open.step == step) open.step = nullptr;
  }
}

void Edits::trim() {
  while (done_.size() > kMostSteps || (values_ > kMostValues && done_.size() > 1)) {
    drop(done_.front().get());
    done_.pop_front();
  }
}

// undoing what is set again at once would be for nothing
bool Edits::goes_on(const Step& step, const World& world) const {
  const bool own = step.who.hand == who_.hand && step.who.ip == who_.ip && (who_.ip == 0 || step.who.port == who_.port);
  return running_ && !own && world.time() - step.time <= kGesture;
}

// In the order in which they were set: a group's value goes to its members, whose own stand behind it. What is now is
// read before any of it is set, for the same reason.
void Edits::exchange(Step& step, Store& store, std::size_t& changed, std::size_t& gone) {
  std::vector<double> now = step.values;
  for (const Edit& edit : step.edits) {
    if (store.alive(edit.id)) std::copy_n(store.values(edit.id, *edit.row), edit.row->width, &now[edit.at]);
  }
  for (const Edit& edit : step.edits) {
    const std::span<const double> kept(&step.values[edit.at], edit.row->width);
    if (!store.alive(edit.id)) {
      gone++;
      continue;
    }
    if (std::memcmp(&now[edit.at], kept.data(), kept.size_bytes()) != 0) changed++;
    (void)store.set(edit.id, *edit.row, kept);
  }
  step.values = std::move(now);
}

Result<void> Edits::exchange(Steps& from, Steps& to, World& world, const char* what) {
  version_++;
  settle(world.store());
  for (std::size_t i = from.size(); i > 0; i--) {
    Step& step = *from[i - 1];
    if (goes_on(step, world)) continue;
    std::size_t changed = 0;
    std::size_t gone = 0;
    quiet_ = true;
    exchange(step, world.store(), changed, gone);
    quiet_ = false;
    const auto at = from.begin() + static_cast<std::ptrdiff_t>(i) - 1;
    told_ = false;
    for (Open& open : open_) {
      if (open.step == &step) open.step = nullptr;
    }
    if (changed == 0) {  // things have gone, or are as they were: the one before is meant
      drop(&step);
      from.erase(at);
      continue;
    }
    hand_.exchange(step.hand);
    to.push_back(std::move(*at));
    from.erase(at);
    if (gone > 0) {
      log_warning("{}: {} value{} of things that have gone {} left out", what, gone, gone == 1 ? "" : "s",
                  gone == 1 ? "was" : "were");
    }
    return {};
  }
  return Error{fmt::format("there is nothing to {}", what)};
}

Result<void> Edits::undo(World& world) { return exchange(done_, undone_, world, "undo"); }
Result<void> Edits::redo(World& world) { return exchange(undone_, done_, world, "redo"); }

void Edits::tell_texts(const Store& store) {
  const auto text_of = [&](const Steps& steps) {
    if (steps.empty()) return std::string();
    const Step& step = *steps.back();
    std::string text = fmt::format("{}/{}", store.path(step.edits[0].id), step.edits[0].row->name);
    if (step.edits.size() > 1) text += fmt::format(" and {} more", step.edits.size() - 1);
    return fmt::format("{} ({})", text, sender_text(step.who));
  };
  undo_text_ = text_of(done_);
  redo_text_ = text_of(undone_);
}

void Edits::follow(const Store& before, const Store& now) {
  for (Steps* steps : {&done_, &undone_}) {
    for (const auto& step : *steps) {
      NodeId known, found;
      for (Edit& edit : step->edits) {
        if (!(edit.id == known)) {
          known = edit.id;
          const Result<Place> place = before.alive(known) ? find_place(now, before.path(known)) : Place{};
          found = place ? place->node : NodeId{};
        }
        const Row* const row = now.alive(found) ? now.table(found).find(edit.row->name) : nullptr;
        const bool same = row != nullptr && row->type == edit.row->type && row->width == edit.row->width;
        edit.id = same ? found : NodeId{};
        if (same) edit.row = row;
      }
    }
  }
  for (Open& open : open_) open.step = nullptr;
  now_ = nullptr;
}

void Edits::clear() {
  done_.clear();
  undone_.clear();
  for (Open& open : open_) open.step = nullptr;
  now_ = nullptr;
  values_ = 0;
  undo_text_.clear();
  redo_text_.clear();
  version_++;
}

std::shared_ptr<const Edits::Memory> Edits::memory() const {
  auto memory = std::make_shared<Memory>();
  for (const auto& step : done_) memory->done_.push_back(*step);
  for (const auto& step : undone_) memory->undone_.push_back(*step);
  for (const Open& open : open_) {
    const auto at = std::find_if(done_.begin(), done_.end(), [&](const auto& step) { return step.get() == open.step; });
    std::optional<Memory::Going>& going = memory->open_.emplace_back();
    if (at != done_.end()) going = {static_cast<std::size_t>(at - done_.begin()), open.number, open.used};
  }
  memory->uses_ = uses_;
  memory->pass_ = pass_;
  memory->values_ = values_;
  memory->undo_text_ = undo_text_;
  memory->redo_text_ = redo_text_;
  return memory;
}

void Edits::bring_back(const Memory& memory) {
  clear();
  for (const Step& step : memory.done_) done_.push_back(std::make_unique<Step>(step));
  for (const Step& step : memory.undone_) undone_.push_back(std::make_unique<Step>(step));
  pass_ = memory.pass_;
  values_ = memory.values_;
  undo_text_ = memory.undo_text_;
  redo_text_ = memory.redo_text_;
  uses_ = memory.uses_;
  for (std::size_t i = 0; i < memory.open_.size(); i++) {
    Open& open = open_[i];
    open.rows.clear();
    if (!memory.open_[i]) continue;
    open.step = done_[memory.open_[i]->step].get();
    open.number = memory.open_[i]->number;
    open.used = memory.open_[i]->used;
    for (const Edit& edit : open.step->edits) open.take(edit.id, *edit.row);
  }
}

}  // namespace limber
