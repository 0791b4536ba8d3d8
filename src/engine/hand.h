// PerformerHand: the last value that was set by hand for each address and names, so that a reset keeps them. [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/message.h"
#include "engine/preset.h"

namespace limber {

/// One of three: a message that was sent, the address of a value that is the scene's again, a preset that was recalled.
struct HandStep {
  const Message* message = nullptr;
  const std::string* address = nullptr;
  const Blend* blend = nullptr;
};

class PerformerHand {
  struct Value {
    Message message;
    std::uint64_t order = 0;
    std::uint64_t noted = 0;  // the newest Before that it is noted in
  };
  struct Recall {
    Blend blend;
    std::uint64_t order = 0;
  };

 public:
  /// What it remembered before some of it was replaced.
  class Before {
    friend class PerformerHand;
    std::uint64_t number_ = 0;
    std::unordered_map<std::string, std::optional<Value>> values_;
    std::optional<std::vector<Recall>> recalls_;
  };
  /// From here on what is replaced is noted there as well, each once; null: no more.
  void note_in(Before* before) {
    noted_ = before;
    if (before != nullptr && before->number_ == 0) before->number_ = ++befores_;
  }
  /// Remembers what is noted there, and notes what it remembered until now.
  void exchange(Before& before);

  /// The message set a property. It replaces an earlier one of the same address and names, and counts as the newest.
  /// Allocates nothing for one that is known.
  void remember(const Message& message);
  /// A reload gave this value what the scene says: nothing that was sent before counts for it any more.
  void give_back(const std::string& address);
  /// The preset was recalled. It replaces an earlier one of the same rows.
  void recall(const Blend& blend);
  /// All of them, the oldest first: done again in this order they leave what the performer left.
  std::vector<HandStep> in_order() const;
  std::size_t size() const { return values_.size() + recalls_.size(); }
  void clear() { bring_back({}); }
  /// Another number whenever it may remember something else.
  std::uint64_t version() const { return version_; }
  /// Remembers what that one remembers.
  void bring_back(const PerformerHand& other) {
    const std::uint64_t version = version_ + 1;
    *this = other;
    version_ = version;
  }

 private:
  std::unordered_map<std::string, Value> values_;            // by address and names
  std::unordered_map<std::string, std::uint64_t> returned_;  // order of the reload, by address
  std::vector<Recall> recalls_;
  Before* noted_ = nullptr;
  std::uint64_t befores_ = 0;
  std::string key_;  // scratch
  std::uint64_t order_ = 0;
  std::uint64_t version_ = 0;
};

}  // namespace limber
