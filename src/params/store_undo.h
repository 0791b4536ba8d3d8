// StoreUndo: what the store was before a guarded call touched it, so that a call that fails can be taken back. [sim]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/id.h"

namespace limber {

struct Row;

/// The log of one call. Its room is kept from call to call.
struct StoreUndo {
  struct Value {
    NodeId id;
    const Row* row = nullptr;
    std::array<double, 4> before{};
    bool marked = false;  ///< Its effect was waiting already.
  };
  /// Which rows of a slot are in the log of which call: each is kept once.
  struct Kept {
    std::uint64_t call = 0;
    std::uint64_t rows = 0;
    std::uint64_t set = 0;  ///< Of these, who listens is told at the call's end.
  };
  /// A row that was set through the door, and what it was.
  struct Set {
    NodeId id;
    const Row* row = nullptr;
    std::array<double, 4> before{};
  };

  bool active = false;
  std::uint64_t call = 0;
  std::vector<Value> values;
  std::vector<Set> set;
  std::vector<Kept> kept;         ///< By slot.
  std::size_t marked_before = 0;  ///< So many nodes waited for their effects when the call began.
};

}  // namespace limber
