// StoreTransaction: the rollback log of a script call. If the call fails, the store is restored from it. [sim]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/id.h"

namespace limber {

struct Property;

/// The log of one transaction. Its memory is reused by the next one.
struct StoreTransaction {
  struct Value {
    NodeId id;
    const Property* property = nullptr;
    std::array<double, 4> previous{};
    bool was_dirty = false;  ///< It was dirty already.
  };
  /// The properties of a slot that are in the log already, as bit masks; each value is saved once per transaction.
  struct Saved {
    std::uint64_t transaction = 0;    ///< The entry is valid in the transaction of this number only.
    std::uint64_t values = 0;         ///< Properties with a saved value.
    std::uint64_t notifications = 0;  ///< Properties with a deferred notification.
  };
  /// A deferred notification: a property that was set, and its previous value.
  struct Notification {
    NodeId id;
    const Property* property = nullptr;
    std::array<double, 4> previous{};
  };

  bool active = false;
  std::uint64_t number = 0;  ///< Number of the transaction, counted from 1.
  std::vector<Value> values;
  std::vector<Notification> notifications;
  std::vector<Saved> saved;      ///< By slot.
  std::size_t dirty_before = 0;  ///< Number of dirty nodes when the transaction began.
};

}  // namespace limber
