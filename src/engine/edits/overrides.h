// Overrides: the values that controllers have set over those of the scene, as the last message for each address and
// leading text arguments (names of objects), so that a reset can apply them again. [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/message.h"
#include "engine/presets/preset.h"

namespace limber::engine {

/// One of three: a message, the address of a released value (it has the scene's value again), or a recalled preset. The
/// others are null.
struct Override {
  const Message* message = nullptr;
  const std::string* address = nullptr;
  const Blend* blend = nullptr;
};

class Overrides {
  struct Value {
    Message message;
    std::uint64_t order = 0;
    std::uint64_t backup = 0;  // number of the last backup that contains the previous value
  };
  struct Recall {
    Blend blend;
    std::uint64_t order = 0;
  };

 public:
  /// The previous state of replaced overrides, for undo.
  struct Backup {
    std::uint64_t number = 0;
    std::unordered_map<std::string, std::optional<Value>> values;
    std::optional<std::vector<Recall>> recalls;
  };
  /// From now on stores in `backup` the previous state of each override that is replaced; null: stops.
  void record_into(Backup* backup) {
    backup_ = backup;
    if (backup != nullptr && backup->number == 0) backup->number = ++backup_count_;
  }
  /// Restores the state in `backup`, and stores the current state there.
  void swap(Backup& backup);

  /// Adds a message that has set a property. It replaces an earlier one with the same address and names, and becomes
  /// the newest. Does not allocate for a known address.
  void add(const Message& message);
  /// Releases a value, because a reload has set it to the scene's value: earlier overrides no longer apply to it.
  void release(const std::string& address);
  /// Adds a recalled preset. It replaces an earlier one of the same properties.
  void add_recall(const Blend& blend);
  /// Returns all overrides, oldest first. Applied in this order they restore the values of the performer.
  std::vector<Override> in_order() const;
  std::size_t size() const { return values_.size() + recalls_.size(); }
  void clear() { restore({}); }
  /// Changes whenever the overrides may have changed.
  std::uint64_t version() const { return version_; }
  /// Copies the overrides of `other`.
  void restore(const Overrides& other) {
    const std::uint64_t version = version_ + 1;
    *this = other;
    version_ = version;
  }

 private:
  std::unordered_map<std::string, Value> values_;            // by address and names
  std::unordered_map<std::string, std::uint64_t> released_;  // order of the release, by address
  std::vector<Recall> recalls_;
  Backup* backup_ = nullptr;
  std::uint64_t backup_count_ = 0;
  std::string key_;  // scratch
  std::uint64_t order_ = 0;
  std::uint64_t version_ = 0;
};

}  // namespace limber::engine
