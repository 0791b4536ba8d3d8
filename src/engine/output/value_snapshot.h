// ValueSnapshot: an immutable copy of the whole tree with all values, made on request, and the values that clients have
// set recently, so that no client is notified of its own changes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "engine/output/snapshot.h"
#include "properties/tree_snapshot.h"

namespace limber::engine {

/// A value set by a client that subscribes to changes (CommandOrigin::is_subscriber).
struct ClientWrite {
  std::uint64_t number = 0;  ///< Counts from 1.
  CommandOrigin origin;
  NodeId node;
  const Property* property = nullptr;
  std::array<double, 4> values{};  ///< The values after clamping.
  bool clamped = false;            ///< `values` differ from those in the message.
};

/// A property's value in a snapshot: numbers, or text. Valid as long as the snapshot.
struct PropertyValue {
  const double* numbers = nullptr;
  std::string_view text;
};

struct ValueSnapshot {
  std::uint64_t number = 0;   ///< Counts from 1 over the engine's life.
  std::uint64_t request = 0;  ///< Serves the requests of EngineLink::request_value_snapshot up to this number.
  std::shared_ptr<const TreeSnapshot> tree;
  std::shared_ptr<const Snapshot> snapshot;  ///< Of the same pass: time and transient values.
  std::vector<double> persistent;
  std::vector<double> computed;
  std::vector<std::string> texts;
  std::vector<ClientWrite>
      writes;  ///< Repeated in ValueSnapshotter::kWriteLifetime snapshots, for readers that skip some.

  /// Returns the value at `where`; an empty one for actions.
  PropertyValue value(const ValueLocation& where) const {
    switch (where.block) {
      case ValueLocation::Block::persistent:
        return {persistent.data() + where.offset, {}};
      case ValueLocation::Block::transient:
        return {snapshot->transient.data() + where.offset, {}};
      case ValueLocation::Block::computed:
        return {computed.data() + where.offset, {}};
      case ValueLocation::Block::texts:
        return {nullptr, texts[where.offset]};
      case ValueLocation::Block::none:
        break;
    }
    return {};
  }
};

}  // namespace limber::engine
