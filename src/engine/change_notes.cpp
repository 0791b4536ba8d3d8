// Values that are set again and again make one line, which has the first and the last.
#include "engine/change_notes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "params/row_text.h"

namespace limber {

void ChangeNotes::begin(const Origin& who, double time) {
  who_ = who;
  time_ = time;
}

void ChangeNotes::heard(NodeId id, const Row& row, const double* before) {
  if (row.kind != RowKind::property) return;
  const std::uint32_t key = (id.slot * 0x9e3779b9u) ^ (row.index * 0x85ebca6bu) ^ (who_.port * 0xc2b2ae35u);
  const auto place = static_cast<std::uint8_t>(key >> 24);
  Note& note = notes_[place];
  const bool same = note.id == id && note.row == &row && note.who == who_ && time_ - note.time <= kGesture;
  if (same && note.touched) {
    note.time = time_;
    return;
  }
  if (note.touched || touched_.size() >= kMostATick) {
    more_++;
    return;
  }
  if (!same) {
    note = {who_, id, &row, {}, 0, time_, true};
    std::copy_n(before, row.width, note.from.begin());
  }
  note.time = time_;
  note.touched = true;
  touched_.push_back(place);
}

void ChangeNotes::tell(const Store& store, Note& note) {
  std::array<double, 4> now{};
  store.get(note.id, *note.row, now.data());
  const bool same = std::equal(now.begin(), now.begin() + note.row->width, note.from.begin());
  if (same && note.line == 0) return;  // it was set to what it was
  std::string to = value_text(*note.row, now.data());
  if (note.line != 0 && log_.renew(note.line, note.time, to)) return;
  note.line = log_.add({0, note.time, sender_text(note.who), fmt::format("{}/{}", store.path(note.id), note.row->name),
                        value_text(*note.row, note.from.data()), std::move(to), 0});
}

void ChangeNotes::tell(const Store& store) {
  for (const std::uint8_t place : touched_) {
    Note& note = notes_[place];
    note.touched = false;
    if (store.alive(note.id)) tell(store, note);
  }
  touched_.clear();
  if (more_ > 0) log_.add({0, time_, sender_text(who_), fmt::format("({} more values)", more_), "", "", 0});
  more_ = 0;
}

}  // namespace limber
