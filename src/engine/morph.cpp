// A list of rows with both their ends, gone through at each tick.
#include "engine/morph.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "engine/recall.h"
#include "sim/behavior.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 4> kEasings = {"linear", "smooth", "in", "out"};

bool is_member(const Store& store, NodeId id) {
  return store.table(id).name() == "behavior" && static_cast<const Behavior*>(store.thing(id))->group() != nullptr;
}

}  // namespace

std::optional<Easing> easing_of(std::string_view name) {
  for (std::size_t i = 0; i < kEasings.size(); i++) {
    if (same_name(name, kEasings[i])) return static_cast<Easing>(i);
  }
  return {};
}

std::string_view easing_names() { return "linear, smooth, in, out"; }

double eased(Easing easing, double part) {
  switch (easing) {
    case Easing::smooth:
      return part * part * (3 - 2 * part);
    case Easing::in:
      return part * part;
    case Easing::out:
      return part * (2 - part);
    case Easing::linear:
      break;
  }
  return part;
}

Morph::Morph(const Store& store, const PresetBinding& binding, Blend to, double time, double seconds, Easing easing)
    : to_(std::move(to)),
      except_(binding.except()),
      begin_(time),
      seconds_(seconds),
      easing_(easing),
      structure_(store.structure_version()) {
  bool group_moves = false;
  each_value(binding, to_, [&](const PresetBinding::Thing& thing, const Row& row, const double* values) {
    const double* const now = store.values(thing.id, row);
    const bool moves = !same_bits(values, now, row.width);
    group_moves = group_moves || (moves && row.written != nullptr && store.table(thing.id).name() == "group");
    if (!moves && !(group_moves && is_member(store, thing.id))) return;
    const Step step{&row, static_cast<std::uint32_t>(values_.size())};
    values_.insert(values_.end(), now, now + row.width);
    values_.insert(values_.end(), values, values + row.width);
    if (!take(store, thing.id, step)) return values_.resize(step.at);
    const auto at = static_cast<std::uint32_t>(steps_.size());
    if (movers_.empty() || movers_.back().id != thing.id) movers_.push_back({thing.id, thing.number, at, at});
    steps_.push_back(step);
    movers_.back().end++;
  });
  left_ = steps_.size();
  index(store);
}

void Morph::index(const Store& store) {
  mover_of_.assign(store.view()->slot_count, static_cast<std::uint32_t>(movers_.size()));
  for (std::size_t i = 0; i < movers_.size(); i++) {
    if (!movers_[i].id.null()) mover_of_[movers_[i].id.slot] = static_cast<std::uint32_t>(i);
  }
}

void Morph::announce(Store& store) const {
  for (const Mover& mover : movers_) {
    for (std::uint32_t i = mover.begin; i < mover.end; i++) {
      if (!steps_[i].gone) store.announce(mover.id, *steps_[i].row, true);
    }
  }
}

void Morph::release(NodeId id, const Row& row) {
  if (id.slot >= mover_of_.size() || mover_of_[id.slot] >= movers_.size()) return;
  const Mover& mover = movers_[mover_of_[id.slot]];
  if (mover.id != id) return;
  for (std::uint32_t i = mover.begin; i < mover.end; i++) {
    if (steps_[i].row != &row || steps_[i].gone || steps_[i].over) continue;
    steps_[i].over = true;
    left_--;
  }
}

double Morph::part(double time) const { return seconds_ > 0 ? std::clamp((time - begin_) / seconds_, 0.0, 1.0) : 1; }

// thing by thing, each with its effects: what has been looked at is still at hand
bool Morph::advance(Store& store, double time) {
  if (structure_ != store.structure_version()) find_again(store);
  const double now = part(time);
  const double amount = now >= 1 ? 1 : eased(easing_, now);
  for (std::size_t i = 0; i < movers_.size(); i++) {
    store.fetch_ahead(i, movers_.size(), [this](std::size_t place) { return movers_[place].id; });
    const Mover& mover = movers_[i];
    std::uint64_t rows = 0;
    for (std::uint32_t k = mover.begin; k < mover.end; k++) {
      if (!steps_[k].gone && !steps_[k].over) rows |= go_on(store, mover.id, steps_[k], amount);
    }
    if (rows != 0) store.run_effects(mover.id, rows);
  }
  return now < 1 && left_ > 0;
}

// the row that was written, as a bit
std::uint64_t Morph::go_on(Store& store, NodeId id, const Step& step, double amount) const {
  const Row& row = *step.row;
  const double* const from = values_.data() + step.at;
  std::array<double, 4> out{};
  mix(row, from, from + row.width, amount, out.data());
  if (same_bits(out.data(), std::as_const(store).values(id, row), row.width)) return 0;
  store.go_on(id, row, out.data());
  return std::uint64_t{1} << row.index;
}

// Both ends as the row takes them, so that it takes all that lies between; false: it does not take them.
bool Morph::take(const Store& store, NodeId id, const Step& step) {
  const Row& row = *step.row;
  for (double* const end : {&values_[step.at], &values_[step.at + row.width]}) {
    std::array<double, 4> taken{};
    if (!store.take(id, row, {end, row.width}, taken.data())) return false;
    std::copy_n(taken.data(), row.width, end);
  }
  return true;
}

// things came or went: what stands under the same name goes on from where the morph is
void Morph::find_again(const Store& store) {
  structure_ = store.structure_version();
  const bool all_there = std::all_of(movers_.begin(), movers_.end(), [&](const Mover& m) { return store.alive(m.id); });
  if (all_there) return;
  const auto binding = PresetBinding::make(store, to_.a->shape, except_, false);
  if (!binding) return;  // its patterns were right when it began
  std::vector<const PresetBinding::Thing*> things(to_.a->shape->things().size());
  for (const PresetBinding::Thing& thing : (*binding)->things()) things[thing.number] = &thing;
  for (Mover& mover : movers_) {
    const PresetBinding::Thing* const thing = things[mover.thing];
    mover.id = thing == nullptr ? NodeId{} : thing->id;
    for (std::uint32_t i = mover.begin; i < mover.end; i++)
      steps_[i].gone = thing == nullptr || !find_again(store, (*binding)->fit(*thing), mover.id, steps_[i]);
  }
  index(store);
}

// whether it has a row of that name and kind
bool Morph::find_again(const Store& store, const PresetBinding::Fit& fit, NodeId id, Step& step) {
  const auto same = std::find_if(fit.rows.begin(), fit.rows.end(), [&](const PresetBinding::FitRow& row) {
    return row.row->name == step.row->name && row.row->type == step.row->type && row.row->choices == step.row->choices;
  });
  if (same == fit.rows.end()) return false;
  step.row = same->row;
  return take(store, id, step);
}

void Morphs::advance(Store& store, double time) {
  std::erase_if(morphs_, [&](Morph& morph) { return !morph.advance(store, time); });
}

void Morphs::release(NodeId id, const Row& row) {
  for (Morph& morph : morphs_) morph.release(id, row);
}

void Morphs::release(const PresetBinding& binding) {
  if (morphs_.empty()) return;
  for (const PresetBinding::Thing& thing : binding.things()) {
    for (const PresetBinding::FitRow& fit : binding.fit(thing).rows) {
      if ((thing.left_alone >> fit.row->index & 1u) == 0) release(thing.id, *fit.row);
    }
  }
  std::erase_if(morphs_, [](const Morph& morph) { return !morph.moves(); });
}

double Morphs::part(double time) const {
  double least = 1;
  for (const Morph& morph : morphs_) least = std::min(least, morph.part(time));
  return least;
}

}  // namespace limber
