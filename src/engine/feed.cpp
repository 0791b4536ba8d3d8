// Values are compared to the bit: what a client knows is what it was sent.
#include "engine/feed.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

constexpr int kBindWork = 10 * PatternBudget::kMessage;  // of all patterns of a client, when things come or go

std::uint64_t key(NodeId node, const Row& row) { return std::uint64_t{node.slot} << 32 | row.index; }

bool same(const double* a, const double* b, std::size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof *a) == 0;
}

}  // namespace

bool Feed::add(std::string_view path, std::int64_t order) {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  if (found != paths_.end() && found->order == order) {
    // asked for again: told again
    for (Value& v : values_) v.told = v.told && v.path != path;
    return true;
  }
  if (found != paths_.end()) paths_.erase(found);
  if (paths_.size() >= kMostPaths) return false;
  const auto at = std::ranges::upper_bound(paths_, order, {}, &Path::order);
  paths_.insert(at, {std::string(path), order, 0, 0, 0, {}});
  unbound_ = true;
  return true;
}

bool Feed::remove(std::string_view path) {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  if (found == paths_.end()) return false;
  paths_.erase(found);
  unbound_ = true;
  return true;
}

void Feed::begin_bind(const std::shared_ptr<const Tree>& tree) {
  tree_ = tree;
  known_.clear();
  // those of a binding that did not end are newer than what was left of the one before
  std::ranges::move(values_, std::back_inserter(before_));
  values_.clear();
  by_place_.clear();
  for (Value& v : before_) known_.insert_or_assign(v.path, &v);
  bind_work_ = {kBindWork};
  binds_next_ = 0;
  truncated_ = false;
  unbound_ = false;
}

// false: there is more to be done
bool Feed::bind_some() {
  const int enough = bind_work_.left - kSliceWork;
  while (binds_next_ < paths_.size()) {
    if (bind_work_.left < enough) return false;
    bind(paths_[binds_next_++]);
  }
  known_.clear();
  before_.clear();
  tree_ = nullptr;
  return true;
}

void Feed::bind(Path& path) {
  path.first = path.end = values_.size();
  path.next = 0;
  path.problem.clear();
  if (values_.size() >= kMostValues) {
    truncated_ = true;
    return;
  }
  bind_work_.spend(PatternBudget::kName);
  PatternBudget budget{std::clamp(bind_work_.left, 0, PatternBudget::kMessage)};
  const int before = budget.left;
  const Result<std::vector<TreePlace>> places = tree_->match(path.text, budget, kMostValues);
  bind_work_.spend(before - budget.left);
  if (!places) {
    path.problem = places.error();
    return;
  }
  truncated_ = truncated_ || places->size() >= kMostValues;
  bool reaches = false;
  for (const TreePlace& place : *places) {
    if (place.row == nullptr || place.row->kind == RowKind::action) continue;
    reaches = true;
    add_value(place);
  }
  path.end = values_.size();
  if (!reaches) path.problem = fmt::format("'{}' is no value", printable(path.text));
}

void Feed::add_value(const TreePlace& place) {
  const std::uint64_t where = key(tree_->nodes()[place.node].id, *place.row);
  if (values_.size() >= kMostValues) {
    truncated_ = truncated_ || !by_place_.contains(where);
    return;
  }
  if (!by_place_.emplace(where, static_cast<std::uint32_t>(values_.size())).second) return;
  Value value;
  value.path = tree_->path(place);
  value.row = place.row;
  value.place = where;
  value.numbers = tree_->numbers(place);
  // another class in its place may have another type of value under that name
  const auto old = known_.find(value.path);
  if (old != known_.end() && old->second->row == place.row) {
    value.told = old->second->told;
    value.known = old->second->known;
    value.known_text = std::move(old->second->known_text);
  }
  values_.push_back(std::move(value));
}

std::string_view Feed::problem(std::string_view path) const {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  return found == paths_.end() ? std::string_view() : found->problem;
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
  while (!hear_some(image, self)) continue;
}

bool Feed::hear_some(const std::shared_ptr<const Image>& image, const Origin& self) {
  if (unbound_ || (tree_ != nullptr ? tree_ != image->tree : image_ == nullptr || image_->tree != image->tree))
    begin_bind(image->tree);
  if (tree_ != nullptr && !bind_some()) return false;
  image_ = image;
  for (const WriteNote& n : image->notes) {
    if (n.number <= heard_note_) continue;
    heard_note_ = n.number;
    if (n.origin == self) note(n);
  }
  return true;
}

void Feed::tell(const Tell& tell_one) {
  if (image_ != nullptr) tell(0, values_.size(), next_, tell_one);
}

std::pair<std::size_t, bool> Feed::tell(std::string_view path, const Tell& tell_one) {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  if (image_ == nullptr || unbound_ || tree_ != nullptr || found == paths_.end()) return {0, true};
  return {found->end - found->first, tell(found->first, found->end, found->next, tell_one)};
}

bool Feed::tell(std::size_t first, std::size_t end, std::size_t& next, const Tell& tell_one) {
  const std::size_t count = end - first;
  if (count == 0) return true;
  next %= count;
  for (std::size_t i = 0; i < count; i++) {
    const std::size_t at = (next + i) % count;
    if (tell_value(values_[first + at], tell_one)) continue;
    next = at;
    return false;
  }
  return true;
}

// false: there was no room for it
bool Feed::tell_value(Value& value, const Tell& tell_one) {
  const RowValue now = image_->value(value.numbers);
  const std::size_t count = value.row->width;
  // who set it itself believes that, whatever it was told before
  if (!value.own && value.told && same(now.numbers, value.known.data(), count) && now.text == value.known_text)
    return true;
  const bool knows = value.own && same(now.numbers, value.set.data(), count);
  if (!knows && !tell_one(value.path, *value.row, now)) return false;
  value.own = false;
  value.told = true;
  std::copy_n(now.numbers, count, value.known.begin());
  value.known_text = now.text;
  return true;
}

}  // namespace limber
