// Feed: values are compared bit by bit with those that the client knows.
#include "engine/output/feed.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::engine {

namespace {

constexpr int kResolveWork = 10 * PatternBudget::kStepsPerMessage;  // budget to resolve all patterns of a client

std::uint64_t key(NodeId node, const Property& property) { return std::uint64_t{node.slot} << 32 | property.index; }

bool same(const double* a, const double* b, std::size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof *a) == 0;
}

}  // namespace

bool Feed::add(std::string_view path, std::int64_t order) {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  if (found != paths_.end() && found->order == order) {
    // a repeated subscription sends the value again
    for (Value& v : values_) v.sent = v.sent && v.path != path;
    return true;
  }
  if (found != paths_.end()) paths_.erase(found);
  if (paths_.size() >= kMaxPaths) return false;
  const auto at = std::ranges::upper_bound(paths_, order, {}, &Path::order);
  paths_.insert(at, {std::string(path), order, 0, 0, 0, {}});
  unresolved_ = true;
  return true;
}

bool Feed::remove(std::string_view path) {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  if (found == paths_.end()) return false;
  paths_.erase(found);
  unresolved_ = true;
  return true;
}

void Feed::begin_resolve(const std::shared_ptr<const TreeSnapshot>& tree) {
  tree_ = tree;
  old_by_path_.clear();
  // values of an unfinished resolution are newer than those before it
  std::ranges::move(values_, std::back_inserter(old_values_));
  values_.clear();
  by_key_.clear();
  for (Value& v : old_values_) old_by_path_.insert_or_assign(v.path, &v);
  resolve_budget_ = {kResolveWork};
  next_path_ = 0;
  truncated_ = false;
  unresolved_ = false;
}

// Returns false if there is more to resolve.
bool Feed::resolve_some() {
  const int stop_at = resolve_budget_.remaining - kSliceWork;
  while (next_path_ < paths_.size()) {
    if (resolve_budget_.remaining < stop_at) return false;
    resolve(paths_[next_path_++]);
  }
  old_by_path_.clear();
  old_values_.clear();
  tree_ = nullptr;
  return true;
}

void Feed::resolve(Path& path) {
  path.first = path.end = values_.size();
  path.next = 0;
  path.problem.clear();
  if (values_.size() >= kMaxValues) {
    truncated_ = true;
    return;
  }
  resolve_budget_.charge(PatternBudget::kStepsPerName);
  PatternBudget budget{std::clamp(resolve_budget_.remaining, 0, PatternBudget::kStepsPerMessage)};
  const int before = budget.remaining;
  const Result<std::vector<TreePropertyRef>> refs = tree_->match(path.text, budget, kMaxValues);
  resolve_budget_.charge(before - budget.remaining);
  if (!refs) {
    path.problem = refs.error();
    return;
  }
  truncated_ = truncated_ || refs->size() >= kMaxValues;
  bool matches = false;
  for (const TreePropertyRef& ref : *refs) {
    if (ref.property == nullptr || ref.property->kind == PropertyKind::action) continue;
    matches = true;
    add_value(ref);
  }
  path.end = values_.size();
  if (!matches) path.problem = fmt::format("'{}' is not a property", printable(path.text));
}

void Feed::add_value(const TreePropertyRef& ref) {
  const std::uint64_t value_key = key(tree_->nodes()[ref.node].id, *ref.property);
  if (values_.size() >= kMaxValues) {
    truncated_ = truncated_ || !by_key_.contains(value_key);
    return;
  }
  if (!by_key_.emplace(value_key, static_cast<std::uint32_t>(values_.size())).second) return;
  Value value;
  value.path = tree_->path(ref);
  value.property = ref.property;
  value.key = value_key;
  value.numbers = tree_->location(ref);
  // a new object at this path may have another type of property of that name
  const auto old = old_by_path_.find(value.path);
  if (old != old_by_path_.end() && old->second->property == ref.property) {
    value.sent = old->second->sent;
    value.sent_value = old->second->sent_value;
    value.sent_text = std::move(old->second->sent_text);
  }
  values_.push_back(std::move(value));
}

std::string_view Feed::problem(std::string_view path) const {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  return found == paths_.end() ? std::string_view() : found->problem;
}

void Feed::note_own_write(const ClientWrite& write) {
  const auto at = by_key_.find(key(write.node, *write.property));
  if (at == by_key_.end()) return;
  Value& value = values_[at->second];
  value.own_write = !write.clamped;
  value.own_value = write.values;
  // a clamped value differs from the one the client has sent: send it even if it has not changed
  if (write.clamped) value.sent = false;
}

void Feed::update(const std::shared_ptr<const ValueSnapshot>& snapshot, const CommandOrigin& self) {
  while (!update_some(snapshot, self)) continue;
}

bool Feed::update_some(const std::shared_ptr<const ValueSnapshot>& snapshot, const CommandOrigin& self) {
  if (unresolved_ ||
      (tree_ != nullptr ? tree_ != snapshot->tree : snapshot_ == nullptr || snapshot_->tree != snapshot->tree))
    begin_resolve(snapshot->tree);
  if (tree_ != nullptr && !resolve_some()) return false;
  snapshot_ = snapshot;
  for (const ClientWrite& write : snapshot->writes) {
    if (write.number <= last_write_) continue;
    last_write_ = write.number;
    if (write.origin == self) note_own_write(write);
  }
  return true;
}

void Feed::send_changes(const Sender& send) {
  if (snapshot_ != nullptr) send_changes(0, values_.size(), next_value_, send);
}

std::pair<std::size_t, bool> Feed::send_changes(std::string_view path, const Sender& send) {
  const auto found = std::ranges::find(paths_, path, &Path::text);
  if (snapshot_ == nullptr || unresolved_ || tree_ != nullptr || found == paths_.end()) return {0, true};
  return {found->end - found->first, send_changes(found->first, found->end, found->next, send)};
}

bool Feed::send_changes(std::size_t first, std::size_t end, std::size_t& next, const Sender& send) {
  const std::size_t count = end - first;
  if (count == 0) return true;
  next %= count;
  for (std::size_t i = 0; i < count; i++) {
    const std::size_t at = (next + i) % count;
    if (send_value(values_[first + at], send)) continue;
    next = at;
    return false;
  }
  return true;
}

// Returns false if the value did not fit.
bool Feed::send_value(Value& value, const Sender& send) {
  const PropertyValue now = snapshot_->value(value.numbers);
  const std::size_t count = value.property->width;
  // after its own write the client assumes that value, regardless of the value it was sent before
  if (!value.own_write && value.sent && same(now.numbers, value.sent_value.data(), count) &&
      now.text == value.sent_text)
    return true;
  const bool client_has_value = value.own_write && same(now.numbers, value.own_value.data(), count);
  if (!client_has_value && !send(value.path, *value.property, now)) return false;
  value.own_write = false;
  value.sent = true;
  std::copy_n(now.numbers, count, value.sent_value.begin());
  value.sent_text = now.text;
  return true;
}

}  // namespace limber::engine
