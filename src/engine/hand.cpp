// What the performer's hand left, in the order in which it was left.
#include "engine/hand.h"

#include <algorithm>

namespace limber {

namespace {
constexpr std::size_t kMostRemembered = 65536;  // a flood of ever new addresses ends here
}

void PerformerHand::remember(const Message& message) {
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
  }
  known->second.message = message;
  known->second.order = ++order_;
}

void PerformerHand::give_back(const std::string& address) {
  if (values_.empty()) return;
  if (returned_.size() >= kMostRemembered && !returned_.contains(address)) return;
  returned_[address] = ++order_;
}

std::vector<HandStep> PerformerHand::in_order() const {
  std::vector<std::pair<std::uint64_t, HandStep>> steps;
  steps.reserve(values_.size() + returned_.size());
  for (const auto& [key, value] : values_) steps.push_back({value.order, {&value.message, nullptr}});
  for (const auto& [address, order] : returned_) steps.push_back({order, {nullptr, &address}});
  std::sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<HandStep> list;
  list.reserve(steps.size());
  for (const auto& [order, step] : steps) list.push_back(step);
  return list;
}

}  // namespace limber
