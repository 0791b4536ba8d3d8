// BehaviorUndo: what a guarded call of a script does to behaviours, so that a call that fails can be taken back. What
// it removes is out of sight until it has ended. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/behavior.h"
#include "sim/behavior_group.h"

namespace limber {

class BehaviorList;

class BehaviorUndo {
 public:
  explicit BehaviorUndo(BehaviorList& list) : list_(list) {}

  /// A call begins.
  void begin();
  /// It ended well: what it removed goes.
  void end();
  /// Generator, beats, error, and whether it is to start: before they are changed. Outside of calls it does nothing.
  void keep(Behavior& behavior);
  /// What it acts on, before that is found anew: as bodies are in the middle of the call.
  void keep_targets(Behavior& behavior);
  /// A body of the call, or with parts of the call, has become a member of a group.
  void made_member(const Behavior& member);
  /// Takes a behaviour, or a group with its members, out of its list and out of sight.
  void hide(Behavior& behavior);
  void hide(BehaviorGroup& group);

 private:
  struct Kept {
    Behavior* behavior = nullptr;
    Random random;
    std::uint64_t seeded_with = 0;
    bool fresh = false;
    BehaviorFault fault;
    std::vector<Behavior::Beat> beats;
  };
  struct Targets {
    Behavior* behavior = nullptr;
    std::vector<Part*> parts;
    std::vector<Joint*> joints;
    std::vector<Motor*> motors;
  };
  struct Hidden {
    std::unique_ptr<Behavior> behavior;  // or
    std::unique_ptr<BehaviorGroup> group;
    NodeId id;
    bool node_hidden = false;  // here; else with its body
    std::size_t place = 0;     // in the list, or among the members of its group
    std::size_t place_on_body = 0;
    std::size_t place_in_tree = 0;  // among its node's siblings
  };
  void hide_node(Hidden& hidden) const;
  void put_away(Hidden hidden);
  void bring_back();

  BehaviorList& list_;
  std::uint64_t call_ = 0;
  std::vector<Kept> kept_;  // the first kept_count_ are of this call; their room is used again
  std::size_t kept_count_ = 0;
  std::vector<Targets> targets_;
  std::vector<Hidden> hidden_;
};

}  // namespace limber
