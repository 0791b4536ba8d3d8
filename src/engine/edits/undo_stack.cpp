// UndoStack: a step stores one value per property. Undo and redo both swap the stored values with the current ones, so
// that the same step can be redone or undone again.
#include "engine/edits/undo_stack.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/plural.h"
#include "properties/catalog.h"

namespace limber::engine {

bool UndoStack::OpenStep::has(NodeId id, const Property& property) const {
  if (id.slot >= masks.size()) return false;
  const SlotMask& slot_mask = masks[id.slot];
  return slot_mask.step == number && slot_mask.generation == id.generation &&
         (slot_mask.mask >> property.index & 1u) != 0;
}

// Returns false if the step already contains the property.
bool UndoStack::OpenStep::add(NodeId id, const Property& property) {
  if (has(id, property)) return false;
  if (id.slot >= masks.size()) masks.resize(id.slot + 1);
  SlotMask& slot_mask = masks[id.slot];
  if (slot_mask.step != number || slot_mask.generation != id.generation) slot_mask = {id.generation, number, 0};
  slot_mask.mask |= std::uint64_t{1} << property.index;
  return true;
}

void UndoStack::begin(const CommandOrigin& source, const sim::World& world) {
  static const Property& paused = sim::World::table().at("paused");
  source_ = source;
  time_ = world.time();
  running_ = world.store().values(world.id(), paused)[0] == 0;
  structure_version_ = world.store().structure_version();
  current_ = nullptr;
  overrides_.record_into(nullptr);
}

void UndoStack::on_write(const Store& store, NodeId id, const Property& property, bool over_time,
                         const double* old_values) {
  // ignore initial values of objects that were created by this command: they are removed with the object
  if (exchanging_ || property.kind != PropertyKind::setting || store.added_version(id) > structure_version_) return;
  version_++;
  if (current_ == nullptr) current_ = &open_step_for(id, property);
  Step& step = *current_->step;
  overrides_.record_into(&step.overrides);
  step.pass = pass_;
  step.time = time_;
  step.over_time = step.over_time || over_time;
  if (!current_->add(id, property)) return;
  if (step.edits.size() >= step.purge_at) purge_removed(step, store);
  step.edits.push_back({id, &property, step.values.size()});
  step.values.insert(step.values.end(), old_values, old_values + property.width);
  value_count_ += property.width;
}

// Purges edits of removed objects, which can't be undone. Without it the step of a controller that never pauses would
// collect the edits of all objects that ever existed.
void UndoStack::purge_removed(Step& step, const Store& store) {
  std::size_t values = 0;
  std::size_t edits = 0;
  for (Edit edit : step.edits) {
    if (!store.alive(edit.id)) continue;
    std::copy_n(&step.values[edit.offset], edit.property->width, &step.values[values]);
    edit.offset = std::exchange(values, values + edit.property->width);
    step.edits[edits++] = edit;
  }
  value_count_ -= step.values.size() - values;
  step.values.resize(values);
  step.edits.resize(edits);
  step.purge_at = std::max(step.purge_at, 2 * step.edits.size());
}

// Returns the step of this controller that the write extends, or a new one.
UndoStack::OpenStep& UndoStack::open_step_for(NodeId id, const Property& property) {
  for (OpenStep& open : open_steps_) {
    if (open.step == nullptr || !(open.step->source == source_) || time_ - open.step->time > kMergeSeconds) continue;
    if (open.step->pass != pass_ && !open.has(id, property)) continue;
    open.last_use = ++uses_;
    return open;
  }
  return open_step();
}

UndoStack::OpenStep& UndoStack::open_step() {
  undo_steps_.push_back(std::make_unique<Step>());
  undo_steps_.back()->source = source_;
  OpenStep& open = *std::min_element(open_steps_.begin(), open_steps_.end(), [](const OpenStep& a, const OpenStep& b) {
    return std::pair(a.step != nullptr, a.last_use) < std::pair(b.step != nullptr, b.last_use);
  });
  open.step = undo_steps_.back().get();
  open.number = open.last_use = ++uses_;
  return open;
}

bool UndoStack::differs(const Step& step, const Store& store) {
  return std::any_of(step.edits.begin(), step.edits.end(), [&](const Edit& edit) {
    return store.alive(edit.id) && std::memcmp(store.values(edit.id, *edit.property), &step.values[edit.offset],
                                               edit.property->width * sizeof(double)) != 0;
  });
}

void UndoStack::end(const Store& store) {
  pass_++;
  complete_steps(store);
}

void UndoStack::complete_steps(const Store& store) {
  current_ = nullptr;
  overrides_.record_into(nullptr);
  bool any_complete = false;
  for (std::size_t i = undo_steps_.size(); i > 0 && !undo_steps_[i - 1]->complete; i--) {
    if (undo_steps_[i - 1]->over_time || differs(*undo_steps_[i - 1], store)) {
      any_complete = undo_steps_[i - 1]->complete = true;
      continue;
    }
    drop(undo_steps_[i - 1].get());
    undo_steps_.erase(undo_steps_.begin() + static_cast<std::ptrdiff_t>(i) - 1);
  }
  // a new step clears the redo stack
  if (any_complete) {
    for (const auto& step : redo_steps_) drop(step.get());
    redo_steps_.clear();
    trim();
    texts_valid_ = false;
  }
  if (!std::exchange(texts_valid_, true)) update_texts(store);
}

void UndoStack::drop(const Step* step) {
  value_count_ -= step->values.size();
  for (OpenStep& open : open_steps_) {
    if (open.step == step) open.step = nullptr;
  }
}

void UndoStack::trim() {
  while (undo_steps_.size() > kMaxSteps || (value_count_ > kMaxValues && undo_steps_.size() > 1)) {
    drop(undo_steps_.front().get());
    undo_steps_.pop_front();
  }
}

// True if another controller is still extending the step, so that an undo would be overwritten at once.
bool UndoStack::extended_by_other(const Step& step, const sim::World& world) const {
  const bool same_source = step.source.source == source_.source && step.source.ip == source_.ip &&
                           (source_.ip.is_any() || step.source.port == source_.port);
  return running_ && !same_source && world.time() - step.time <= kMergeSeconds;
}

// Sets the values in the order in which they were set, because the value of a group is copied to its members, which may
// have been set after it. For the same reason all current values are read before the first is set.
void UndoStack::exchange(Step& step, Store& store, std::size_t& changed, std::size_t& removed) {
  std::vector<double> current = step.values;
  for (const Edit& edit : step.edits) {
    if (store.alive(edit.id))
      std::copy_n(store.values(edit.id, *edit.property), edit.property->width, &current[edit.offset]);
  }
  for (const Edit& edit : step.edits) {
    const std::span<const double> stored(&step.values[edit.offset], edit.property->width);
    if (!store.alive(edit.id)) {
      removed++;
      continue;
    }
    if (std::memcmp(&current[edit.offset], stored.data(), stored.size_bytes()) != 0) changed++;
    (void)store.set(edit.id, *edit.property, stored);
  }
  step.values = std::move(current);
}

Result<void> UndoStack::exchange(Steps& from, Steps& to, sim::World& world, const char* verb) {
  version_++;
  complete_steps(world.store());
  for (std::size_t i = from.size(); i > 0; i--) {
    Step& step = *from[i - 1];
    if (extended_by_other(step, world)) continue;
    std::size_t changed = 0;
    std::size_t removed = 0;
    exchanging_ = true;
    exchange(step, world.store(), changed, removed);
    exchanging_ = false;
    const auto at = from.begin() + static_cast<std::ptrdiff_t>(i) - 1;
    texts_valid_ = false;
    for (OpenStep& open : open_steps_) {
      if (open.step == &step) open.step = nullptr;
    }
    if (changed == 0) {  // objects were removed or values are the same: skip this step
      drop(&step);
      from.erase(at);
      continue;
    }
    overrides_.swap(step.overrides);
    to.push_back(std::move(*at));
    from.erase(at);
    if (removed > 0) {
      log_warning("{}: {} of removed objects {} skipped", verb, counted(removed, "value"),
                  plural(removed, "was", "were"));
    }
    return {};
  }
  return Error{fmt::format("there is nothing to {}", verb)};
}

Result<void> UndoStack::undo(sim::World& world) { return exchange(undo_steps_, redo_steps_, world, "undo"); }
Result<void> UndoStack::redo(sim::World& world) { return exchange(redo_steps_, undo_steps_, world, "redo"); }

void UndoStack::update_texts(const Store& store) {
  const auto text_of = [&](const Steps& steps) {
    if (steps.empty()) return std::string();
    const Step& step = *steps.back();
    std::string text = fmt::format("{}/{}", store.path(step.edits[0].id), step.edits[0].property->name);
    if (step.edits.size() > 1) text += fmt::format(" and {} more", step.edits.size() - 1);
    return fmt::format("{} ({})", text, sender_text(step.source));
  };
  undo_text_ = text_of(undo_steps_);
  redo_text_ = text_of(redo_steps_);
}

void UndoStack::rebind(const Store& before, const Store& now) {
  for (Steps* steps : {&undo_steps_, &redo_steps_}) {
    for (const auto& step : *steps) {
      NodeId known, found;
      for (Edit& edit : step->edits) {
        if (!(edit.id == known)) {
          known = edit.id;
          const Result<PropertyRef> ref = before.alive(known) ? find_property(now, before.path(known)) : PropertyRef{};
          found = ref ? ref->node : NodeId{};
        }
        const Property* const property = now.alive(found) ? now.table(found).find(edit.property->name) : nullptr;
        const bool same =
            property != nullptr && property->type == edit.property->type && property->width == edit.property->width;
        edit.id = same ? found : NodeId{};
        if (same) edit.property = property;
      }
    }
  }
  for (OpenStep& open : open_steps_) open.step = nullptr;
  current_ = nullptr;
}

void UndoStack::clear() {
  undo_steps_.clear();
  redo_steps_.clear();
  for (OpenStep& open : open_steps_) open.step = nullptr;
  current_ = nullptr;
  value_count_ = 0;
  undo_text_.clear();
  redo_text_.clear();
  version_++;
}

std::shared_ptr<const UndoStack::State> UndoStack::state() const {
  auto state = std::make_shared<State>();
  for (const auto& step : undo_steps_) state->undo_steps.push_back(*step);
  for (const auto& step : redo_steps_) state->redo_steps.push_back(*step);
  for (const OpenStep& open : open_steps_) {
    const auto at =
        std::find_if(undo_steps_.begin(), undo_steps_.end(), [&](const auto& step) { return step.get() == open.step; });
    std::optional<State::OpenRef>& ref = state->open_steps.emplace_back();
    if (at != undo_steps_.end()) ref = {static_cast<std::size_t>(at - undo_steps_.begin()), open.number, open.last_use};
  }
  state->uses = uses_;
  state->pass = pass_;
  state->value_count = value_count_;
  state->undo_text = undo_text_;
  state->redo_text = redo_text_;
  return state;
}

void UndoStack::restore(const State& state) {
  clear();
  for (const Step& step : state.undo_steps) undo_steps_.push_back(std::make_unique<Step>(step));
  for (const Step& step : state.redo_steps) redo_steps_.push_back(std::make_unique<Step>(step));
  pass_ = state.pass;
  value_count_ = state.value_count;
  undo_text_ = state.undo_text;
  redo_text_ = state.redo_text;
  uses_ = state.uses;
  for (std::size_t i = 0; i < state.open_steps.size(); i++) {
    OpenStep& open = open_steps_[i];
    open.masks.clear();
    if (!state.open_steps[i]) continue;
    open.step = undo_steps_[state.open_steps[i]->step].get();
    open.number = state.open_steps[i]->number;
    open.last_use = state.open_steps[i]->last_use;
    for (const Edit& edit : open.step->edits) open.add(edit.id, *edit.property);
  }
}

}  // namespace limber::engine
