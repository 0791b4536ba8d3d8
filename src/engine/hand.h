// PerformerHand: the last value that was set by hand for each address and names, so that a reset keeps them. [sim]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/message.h"

namespace limber {

class PerformerHand {
 public:
  /// The message set a property. It replaces an earlier one of the same address and names, and counts as the newest.
  /// Allocates nothing for one that is known.
  void remember(const Message& message);
  /// All of them, the oldest first: sent again in this order they leave what the performer left.
  std::vector<const Message*> in_order() const;
  std::size_t size() const { return values_.size(); }

 private:
  struct Value {
    Message message;
    std::uint64_t order = 0;
  };
  std::unordered_map<std::string, Value> values_;  // by address and names
  std::string key_;                                // scratch
  std::uint64_t order_ = 0;
};

}  // namespace limber
