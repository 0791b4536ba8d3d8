// Overrides in the order in which they were set.
#include "engine/edits/overrides.h"

#include <algorithm>

namespace limber::engine {

namespace {
constexpr std::size_t kMaxOverrides = 65536;  // limits a flood of different addresses
constexpr std::size_t kMaxRecalls = 64;

// True if `second` sets every property that `first` sets.
bool replaces(const Blend& first, const Blend& second) {
  return first.a->schema == second.a->schema && first.a->selection.except == second.a->selection.except &&
         first.b->selection.except == second.b->selection.except;
}
}  // namespace

void Overrides::add(const Message& message) {
  version_++;
  key_ = message.address;
  for (const Arg& arg : message.args) {
    if (!arg.is_text()) break;
    key_ += '\n';
    key_ += arg.text;
  }
  auto known = values_.find(key_);
  if (known == values_.end()) {
    if (values_.size() >= kMaxOverrides) return;
    known = values_.emplace(key_, Value{}).first;
    if (backup_ != nullptr) backup_->values.try_emplace(key_);
  } else if (backup_ != nullptr && known->second.backup != backup_->number) {
    backup_->values.try_emplace(key_, known->second);
  }
  if (backup_ != nullptr) known->second.backup = backup_->number;
  known->second.message = message;
  known->second.order = ++order_;
}

void Overrides::release(const std::string& address) {
  if (size() == 0) return;
  version_++;
  if (released_.size() >= kMaxOverrides && !released_.contains(address)) return;
  released_[address] = ++order_;
}

void Overrides::add_recall(const Blend& blend) {
  version_++;
  if (backup_ != nullptr && !backup_->recalls) backup_->recalls = recalls_;
  std::erase_if(recalls_, [&](const Recall& recall) { return replaces(recall.blend, blend); });
  if (recalls_.size() >= kMaxRecalls) recalls_.erase(recalls_.begin());
  recalls_.push_back({blend, ++order_});
}

void Overrides::swap(Backup& backup) {
  version_++;
  for (auto& [key, value] : backup.values) {
    std::optional<Value> now;
    if (const auto known = values_.find(key); known != values_.end()) now = known->second;
    if (value) {
      values_[key] = *value;
    } else {
      values_.erase(key);
    }
    value = std::move(now);
  }
  if (backup.recalls) std::swap(recalls_, *backup.recalls);
}

std::vector<Override> Overrides::in_order() const {
  std::vector<std::pair<std::uint64_t, Override>> steps;
  steps.reserve(values_.size() + released_.size() + recalls_.size());
  for (const auto& [key, value] : values_) steps.push_back({value.order, {&value.message, nullptr, nullptr}});
  for (const auto& [address, order] : released_) steps.push_back({order, {nullptr, &address, nullptr}});
  for (const Recall& recall : recalls_) steps.push_back({recall.order, {nullptr, nullptr, &recall.blend}});
  std::sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Override> list;
  list.reserve(steps.size());
  for (const auto& [order, entry] : steps) list.push_back(entry);
  return list;
}

}  // namespace limber::engine
