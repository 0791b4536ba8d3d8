// TakeNode: what the tree tells of takes, at /take: the one that is recorded, or replayed. [sim]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sim/world.h"

namespace limber {

class TakeNode {
 public:
  static const Table& table();

  explicit TakeNode(World& world);

  struct Told {
    std::string_view name;    ///< Empty: no take.
    bool replays = false;     ///< It is replayed, not recorded.
    std::uint64_t ticks = 0;  ///< So far.
    std::uint64_t whole = 0;  ///< Of a replay: how many there are.
    bool plays = false;       ///< It is replayed in the place of a show.
  };
  /// Allocates nothing while the take is the same.
  void tell(const Told& told);

 private:
  std::string_view say_name() const { return name_; }

  World& world_;
  NodeId id_;
  std::string name_;
};

}  // namespace limber
