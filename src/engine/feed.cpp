// Values are compared to the bit: what a client knows is what it was sent.
#include "engine/feed.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace limber {

namespace {

constexpr int kBindWork = 10 * PatternBudget::kMessage;  // of all patterns of a client, when things come or go

std::uint64_t key(NodeId node, const Row& row) { return std::uint64_t{node.slot} << 32 | row.index; }

bool same(const double* a, const double* b, std::size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof *a) == 0;
}

}  // namespace

bool Feed::add(std::string_view path) {
  if (std::find(paths_.begin(), paths_.end(), path) != paths_.end()) {
    // asked for again: told again
    for (Value& v : values_) v.told = v.told && v.path != path;
    return true;
  }
  if (paths_.size() >= kMostPaths) return false;
  paths_.emplace_back(path);
  unbound_ = true;
  return true;
}

bool Feed::remove(std::string_view path) {
  const auto found = std::find(paths_.begin(), paths_.end(), path);
  if (found == paths_.end()) return false;
  paths_.erase(found);
  unbound_ = true;
  return true;
}

void Feed::bind(const Tree& tree) {
  std::vector<Value> before = std::exchange(values_, {});
  std::unordered_map<std::string_view, Value*> known;
  for (Value& v : before) known.emplace(v.path, &v);
  by_place_.clear();
  PatternBudget budget{kBindWork};
  for (const std::string& path : paths_) {
    const Result<std::vector<TreePlace>> places = tree.match(path, budget, kMostValues);
    if (!places) continue;
    for (const TreePlace& place : *places) {
      if (place.row == nullptr || place.row->kind == RowKind::action || values_.size() >= kMostValues) continue;
      const std::uint64_t where = key(tree.nodes()[place.node].id, *place.row);
      if (!by_place_.emplace(where, static_cast<std::uint32_t>(values_.size())).second) continue;
      Value value;
      value.path = tree.path(place);
      value.row = place.row;
      value.place = where;
      value.numbers = tree.numbers(place);
      // another class in its place may have another type of value under that name
      const auto old = known.find(value.path);
      if (old != known.end() && old->second->row == place.row) {
        value.told = old->second->told;
        value.known = old->second->known;
        value.known_text = std::move(old->second->known_text);
      }
      values_.push_back(std::move(value));
    }
  }
  unbound_ = false;
}

void Feed::note(const WriteNote& note) {
  const auto at = by_place_.find(key(note.node, *note.row));
  if (at == by_place_.end()) return;
  Value& value = values_[at->second];
  value.own = !note.clamped;
  value.set = note.values;
  // what was brought into the range is not what the client believes: it is told, even if it was so before
  if (note.clamped) value.told = false;
}

void Feed::hear(const std::shared_ptr<const Image>& image, const Origin& self) {
  if (unbound_ || image_ == nullptr || image_->tree != image->tree) bind(*image->tree);
  image_ = image;
  for (const WriteNote& n : image->notes) {
    if (n.number <= heard_note_) continue;
    heard_note_ = n.number;
    if (n.origin == self) note(n);
  }
}

void Feed::tell(const Tell& tell) {
  if (image_ == nullptr || values_.empty()) return;
  next_ %= values_.size();
  for (std::size_t i = 0; i < values_.size(); i++) {
    const std::size_t at = (next_ + i) % values_.size();
    Value& value = values_[at];
    const RowValue now = image_->value(value.numbers);
    const std::size_t count = value.row->width;
    // who set it itself believes that, whatever it was told before
    if (!value.own && value.told && same(now.numbers, value.known.data(), count) && now.text == value.known_text) {
      continue;
    }
    const bool knows = value.own && same(now.numbers, value.set.data(), count);
    if (!knows && !tell(value.path, *value.row, now)) {
      next_ = at;
      return;
    }
    value.own = false;
    value.told = true;
    std::copy_n(now.numbers, count, value.known.begin());
    value.known_text = now.text;
  }
}

}  // namespace limber
