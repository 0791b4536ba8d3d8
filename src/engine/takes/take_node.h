// TakeNode: publishes the state of recording and replay in the property tree, at /take. [sim]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sim/world/world.h"

namespace limber::engine {

class TakeNode {
 public:
  static const PropertyTable& table();

  explicit TakeNode(sim::World& world);

  /// The take that is being recorded or replayed.
  struct Status {
    std::string_view name;          ///< Empty: none.
    bool replaying = false;         ///< It is being replayed, not recorded.
    std::uint64_t ticks = 0;        ///< Recorded or replayed so far.
    std::uint64_t total_ticks = 0;  ///< Replay: number of ticks of the take; else 0.
    bool in_session = false;        ///< It is being played inside a running session.
  };
  /// Updates the properties. Doesn't allocate while the name stays the same.
  void publish(const Status& status);

 private:
  std::string_view read_name() const { return name_; }

  sim::World& world_;
  NodeId id_;
  std::string name_;
};

}  // namespace limber::engine
