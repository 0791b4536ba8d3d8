// What the performer's hand left, in the order in which it was left.
#include "engine/hand.h"

#include <algorithm>

namespace limber {

namespace {
constexpr std::size_t kMostValues = 65536;  // a flood of ever new addresses ends here
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
    if (values_.size() >= kMostValues) return;
    known = values_.emplace(key_, Value{}).first;
  }
  known->second.message = message;
  known->second.order = ++order_;
}

std::vector<const Message*> PerformerHand::in_order() const {
  std::vector<const Value*> values;
  values.reserve(values_.size());
  for (const auto& [key, value] : values_) values.push_back(&value);
  std::sort(values.begin(), values.end(), [](const Value* a, const Value* b) { return a->order < b->order; });
  std::vector<const Message*> messages;
  messages.reserve(values.size());
  for (const Value* value : values) messages.push_back(&value->message);
  return messages;
}

}  // namespace limber
