// What the performer's hand left, in the order in which it was left.
#include "engine/hand.h"

#include <algorithm>

namespace limber {

namespace {
constexpr std::size_t kMostRemembered = 65536;  // a flood of ever new addresses ends here
constexpr std::size_t kMostRecalls = 64;

// whether the second sets every row that the first does
bool covers(const Blend& first, const Blend& second) {
  return first.a->shape == second.a->shape && first.a->choice.except == second.a->choice.except &&
         first.b->choice.except == second.b->choice.except;
}
}  // namespace

void PerformerHand::remember(const Message& message) {
  version_++;
  key_ = message.address;
  for (const Arg& arg : message.args) {
    if (!arg.is_text()) break;
    key_ += '\n';
    key_ += arg.text;
  }
  auto known = values_.find(key_);
  if (known == values_.end()) {
    if (values_.size() >= kMostRemembered) return;
    known = values_.emplace(key_, Value{}).first;
    if (noted_ != nullptr) noted_->values_.try_emplace(key_);
  } else if (noted_ != nullptr && known->second.noted != noted_->number_) {
    noted_->values_.try_emplace(key_, known->second);
  }
  if (noted_ != nullptr) known->second.noted = noted_->number_;
  known->second.message = message;
  known->second.order = ++order_;
}

void PerformerHand::give_back(const std::string& address) {
  if (size() == 0) return;
  version_++;
  if (returned_.size() >= kMostRemembered && !returned_.contains(address)) return;
  returned_[address] = ++order_;
}

void PerformerHand::recall(const Blend& blend) {
  version_++;
  if (noted_ != nullptr && !noted_->recalls_) noted_->recalls_ = recalls_;
  std::erase_if(recalls_, [&](const Recall& r) { return covers(r.blend, blend); });
  if (recalls_.size() >= kMostRecalls) recalls_.erase(recalls_.begin());
  recalls_.push_back({blend, ++order_});
}

void PerformerHand::exchange(Before& before) {
  version_++;
  for (auto& [key, value] : before.values_) {
    std::optional<Value> now;
    if (const auto known = values_.find(key); known != values_.end()) now = known->second;
    if (value) {
      values_[key] = *value;
    } else {
      values_.erase(key);
    }
    value = std::move(now);
  }
  if (before.recalls_) std::swap(recalls_, *before.recalls_);
}

std::vector<HandStep> PerformerHand::in_order() const {
  std::vector<std::pair<std::uint64_t, HandStep>> steps;
  steps.reserve(values_.size() + returned_.size() + recalls_.size());
  for (const auto& [key, value] : values_) steps.push_back({value.order, {&value.message, nullptr, nullptr}});
  for (const auto& [address, order] : returned_) steps.push_back({order, {nullptr, &address, nullptr}});
  for (const Recall& recall : recalls_) steps.push_back({recall.order, {nullptr, nullptr, &recall.blend}});
  std::sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<HandStep> list;
  list.reserve(steps.size());
  for (const auto& [order, step] : steps) list.push_back(step);
  return list;
}

}  // namespace limber
