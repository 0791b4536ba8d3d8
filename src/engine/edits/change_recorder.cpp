// ChangeRecorder: repeated changes of a value are merged into one line, with the first old and the last new value.
#include "engine/edits/change_recorder.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/plural.h"
#include "properties/property_text.h"

namespace limber::engine {

void ChangeRecorder::begin(const CommandOrigin& source, double time) {
  source_ = source;
  time_ = time;
}

void ChangeRecorder::on_write(NodeId id, const Property& property, const double* old_values) {
  if (property.kind != PropertyKind::setting) return;
  const std::uint32_t key = (id.slot * 0x9e3779b9u) ^ (property.index * 0x85ebca6bu) ^ (source_.port * 0xc2b2ae35u);
  const auto slot = static_cast<std::uint8_t>(key >> 24);
  Note& note = notes_[slot];
  const bool same =
      note.id == id && note.property == &property && note.source == source_ && time_ - note.time <= kMergeSeconds;
  if (same && note.touched) {
    note.time = time_;
    return;
  }
  if (note.touched || touched_.size() >= kMaxPerTick) {
    omitted_++;
    return;
  }
  if (!same) {
    note = {source_, id, &property, {}, 0, time_, true};
    std::copy_n(old_values, property.width, note.old_value.begin());
  }
  note.time = time_;
  note.touched = true;
  touched_.push_back(slot);
}

void ChangeRecorder::flush(const Store& store, Note& note) {
  std::array<double, 4> now{};
  store.get(note.id, *note.property, now.data());
  const bool same = std::equal(now.begin(), now.begin() + note.property->width, note.old_value.begin());
  if (same && note.entry_number == 0) return;  // set to the same value
  std::string to = value_text(*note.property, now.data());
  if (note.entry_number != 0 && log_.update(note.entry_number, note.time, to)) return;
  note.entry_number =
      log_.add({0, note.time, sender_text(note.source), fmt::format("{}/{}", store.path(note.id), note.property->name),
                value_text(*note.property, note.old_value.data()), std::move(to), 0});
}

void ChangeRecorder::flush(const Store& store) {
  for (const std::uint8_t slot : touched_) {
    Note& note = notes_[slot];
    note.touched = false;
    if (store.alive(note.id)) flush(store, note);
  }
  touched_.clear();
  if (omitted_ > 0)
    log_.add({0, time_, sender_text(source_), fmt::format("({})", counted(omitted_, "more value")), "", "", 0});
  omitted_ = 0;
}

}  // namespace limber::engine
