// Interpolation of a list of properties, each with its start and end value.
#include "engine/presets/morph.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "sim/behavior/behavior.h"

namespace limber::engine {

namespace {

constexpr std::array<std::string_view, 4> kEasings = {"linear", "smooth", "in", "out"};

bool is_member(const Store& store, NodeId id) {
  return store.table(id).name() == "behavior" &&
         static_cast<const sim::Behavior*>(store.object(id))->group() != nullptr;
}

}  // namespace

std::optional<Easing> easing_of(std::string_view name) {
  for (std::size_t i = 0; i < kEasings.size(); i++) {
    if (same_name(name, kEasings[i])) return static_cast<Easing>(i);
  }
  return {};
}

std::string_view easing_names() { return "linear, smooth, in, out"; }

std::vector<std::string> easings() {
  std::vector<std::string> names;
  for (std::string_view name : split(easing_names(), ',')) {
    if (name.starts_with(' ')) name.remove_prefix(1);
    names.emplace_back(name);
  }
  return names;
}

double ease(Easing easing, double fraction) {
  switch (easing) {
    case Easing::smooth:
      return fraction * fraction * (3 - 2 * fraction);
    case Easing::in:
      return fraction * fraction;
    case Easing::out:
      return fraction * (2 - fraction);
    case Easing::linear:
      break;
  }
  return fraction;
}

Morph::Morph(const Store& store, const PresetBinding& binding, Blend goal, double time, double seconds, Easing easing)
    : goal_(std::move(goal)),
      except_(binding.except()),
      begin_(time),
      seconds_(seconds),
      easing_(easing),
      structure_version_(store.structure_version()) {
  bool group_changes = false;
  for_each_value(binding, goal_, [&](const PresetBinding::Node& node, const Property& property, const double* values) {
    const double* const now = store.values(node.id, property);
    const bool changes = !same_bits(values, now, property.width);
    group_changes =
        group_changes || (changes && property.on_write != nullptr && store.table(node.id).name() == "group");
    if (!changes && !(group_changes && is_member(store, node.id))) return;
    const Track track{&property, static_cast<std::uint32_t>(values_.size())};
    values_.insert(values_.end(), now, now + property.width);
    values_.insert(values_.end(), values, values + property.width);
    if (!validate_track(store, node.id, track)) return values_.resize(track.offset);
    const auto at = static_cast<std::uint32_t>(tracks_.size());
    if (targets_.empty() || targets_.back().id != node.id) targets_.push_back({node.id, node.index, at, at});
    tracks_.push_back(track);
    targets_.back().tracks_end++;
  });
  active_tracks_ = tracks_.size();
  index_targets(store);
}

void Morph::index_targets(const Store& store) {
  target_of_slot_.assign(store.view()->slot_count, static_cast<std::uint32_t>(targets_.size()));
  for (std::size_t i = 0; i < targets_.size(); i++) {
    if (!targets_[i].id.null()) target_of_slot_[targets_[i].id.slot] = static_cast<std::uint32_t>(i);
  }
}

void Morph::announce(Store& store) const {
  for (const Target& target : targets_) {
    for (std::uint32_t i = target.tracks_begin; i < target.tracks_end; i++) {
      if (!tracks_[i].missing) store.notify(target.id, *tracks_[i].property, true);
    }
  }
}

void Morph::release(NodeId id, const Property& property) {
  if (id.slot >= target_of_slot_.size() || target_of_slot_[id.slot] >= targets_.size()) return;
  const Target& target = targets_[target_of_slot_[id.slot]];
  if (target.id != id) return;
  for (std::uint32_t i = target.tracks_begin; i < target.tracks_end; i++) {
    if (tracks_[i].property != &property || tracks_[i].missing || tracks_[i].released) continue;
    tracks_[i].released = true;
    active_tracks_--;
  }
}

double Morph::progress(double time) const {
  return seconds_ > 0 ? std::clamp((time - begin_) / seconds_, 0.0, 1.0) : 1;
}

// Runs the on-change callbacks node by node, while the data of the node is still in the cache.
bool Morph::advance(Store& store, double time) {
  if (structure_version_ != store.structure_version()) rebind(store);
  const double fraction = progress(time);
  const double amount = fraction >= 1 ? 1 : ease(easing_, fraction);
  for (std::size_t i = 0; i < targets_.size(); i++) {
    store.prefetch_ahead(i, targets_.size(), [this](std::size_t index) { return targets_[index].id; });
    const Target& target = targets_[i];
    std::uint64_t properties = 0;
    for (std::uint32_t k = target.tracks_begin; k < target.tracks_end; k++) {
      if (!tracks_[k].missing && !tracks_[k].released) properties |= write_track(store, target.id, tracks_[k], amount);
    }
    if (properties != 0) store.run_callbacks(target.id, properties);
  }
  return fraction < 1 && active_tracks_ > 0;
}

// Writes one property if its value changes; returns its bit, else 0.
std::uint64_t Morph::write_track(Store& store, NodeId id, const Track& track, double amount) const {
  const Property& property = *track.property;
  const double* const from = values_.data() + track.offset;
  std::array<double, 4> out{};
  mix(property, from, from + property.width, amount, out.data());
  if (same_bits(out.data(), std::as_const(store).values(id, property), property.width)) return 0;
  store.write_unchecked(id, property, out.data());
  return std::uint64_t{1} << property.index;
}

// Validates both end values, so that all values between them are valid. False if one is rejected.
bool Morph::validate_track(const Store& store, NodeId id, const Track& track) {
  const Property& property = *track.property;
  for (double* const end : {&values_[track.offset], &values_[track.offset + property.width]}) {
    std::array<double, 4> valid{};
    if (!store.validate(id, property, {end, property.width}, valid.data())) return false;
    std::copy_n(valid.data(), property.width, end);
  }
  return true;
}

// Nodes were added or removed: binds again by name, continuing from the current progress.
void Morph::rebind(const Store& store) {
  structure_version_ = store.structure_version();
  const bool all_there =
      std::all_of(targets_.begin(), targets_.end(), [&](const Target& target) { return store.alive(target.id); });
  if (all_there) return;
  const auto binding = PresetBinding::make(store, goal_.a->schema, except_, false);
  if (!binding) return;  // can't fail: its patterns were valid at the start
  std::vector<const PresetBinding::Node*> nodes(goal_.a->schema->nodes().size());
  for (const PresetBinding::Node& node : (*binding)->nodes()) nodes[node.index] = &node;
  for (Target& target : targets_) {
    const PresetBinding::Node* const node = nodes[target.node];
    target.id = node == nullptr ? NodeId{} : node->id;
    for (std::uint32_t i = target.tracks_begin; i < target.tracks_end; i++)
      tracks_[i].missing = node == nullptr || !rebind(store, (*binding)->layout(*node), target.id, tracks_[i]);
  }
  index_targets(store);
}

// Binds to a property of the same name and type. False if there is none.
bool Morph::rebind(const Store& store, const PresetBinding::LayoutBinding& layout, NodeId id, Track& track) {
  const auto same = std::find_if(
      layout.properties.begin(), layout.properties.end(), [&](const PresetBinding::BoundProperty& property) {
        return property.property->name == track.property->name && property.property->type == track.property->type &&
               property.property->choices == track.property->choices;
      });
  if (same == layout.properties.end()) return false;
  track.property = same->property;
  return validate_track(store, id, track);
}

void Morphs::advance(Store& store, double time) {
  std::erase_if(morphs_, [&](Morph& morph) { return !morph.advance(store, time); });
}

void Morphs::release(NodeId id, const Property& property) {
  for (Morph& morph : morphs_) morph.release(id, property);
}

void Morphs::release(const PresetBinding& binding) {
  if (morphs_.empty()) return;
  for (const PresetBinding::Node& node : binding.nodes()) {
    for (const PresetBinding::BoundProperty& bound : binding.layout(node).properties) {
      if ((node.excluded >> bound.property->index & 1u) == 0) release(node.id, *bound.property);
    }
  }
  std::erase_if(morphs_, [](const Morph& morph) { return !morph.active(); });
}

double Morphs::progress(double time) const {
  double slowest = 1;
  for (const Morph& morph : morphs_) slowest = std::min(slowest, morph.progress(time));
  return slowest;
}

}  // namespace limber::engine
