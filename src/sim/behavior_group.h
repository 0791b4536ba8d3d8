// BehaviorGroup: one behaviour on several bodies, an instance a body, all under one name. Bodies that come and go
// become members and cease to be. What is written to the group goes to every member. [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/behavior.h"

namespace limber {

/// What a group acts on. Its neighbours are parts of all bodies that it means, own parts or not.
struct GroupSetup {
  Selection bodies;
  Selection parts;
  Selection neighbor_parts;  ///< Left out: as `parts`.
  bool operator==(const GroupSetup&) const = default;
};

class BehaviorGroup {
 public:
  static std::vector<Row> common_rows();
  /// A group's row was written: its members' rows follow.
  static void hand_on(void* thing, const Row& row);

  ~BehaviorGroup();
  BehaviorGroup(const BehaviorGroup&) = delete;
  BehaviorGroup& operator=(const BehaviorGroup&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  const BehaviorType& type() const { return *type_; }
  const GroupSetup& setup() const { return setup_; }
  World& world() const { return world_; }
  /// In the order in which they became members.
  std::span<const std::unique_ptr<Behavior>> members() const { return members_; }
  /// Parts that members look at, in stream order; a member leaves out those of its own body.
  std::span<Part* const> neighbor_parts() const { return neighbor_parts_; }
  /// Seconds of the last tick, spread over the members.
  double seconds_a_member() const;

  std::uint64_t state_hash(std::uint64_t start) const;

 private:
  friend class Behavior;
  friend class BehaviorList;
  BehaviorGroup(World& world, NodeId parent, std::string name, std::shared_ptr<const BehaviorType> type,
                GroupSetup setup);

  Behavior* member_of(const Body& body) const;
  /// Whether a body is meant: by the selection, or as a copy of a member.
  bool means(const Body& body) const;
  const Selection& neighbor_selection() const;
  /// Members and neighbours anew, after bodies came, went or changed. The error names a body or part that is missing.
  Result<void> follow();
  Result<Behavior*> join(Body& body);
  /// Takes the type that now has its type's name; members are renewed by the list.
  void renew(const std::shared_ptr<const BehaviorType>& type);
  void forget_parts_of(const Body& body);
  void step(double dt);
  Result<void> names_exist() const;
  void read_time(double* out) const;
  Result<void> act_remove(std::span<const double> args);

  World& world_;
  NodeId id_;
  std::shared_ptr<const BehaviorType> type_;
  GroupSetup setup_;
  std::shared_ptr<const BehaviorSetup> member_setup_;
  std::vector<std::unique_ptr<Behavior>> members_;
  std::vector<Behavior*> running_;  // scratch of a tick
  std::vector<NodeId> left_;        // bodies whose instance was taken away by hand
  std::vector<Part*> neighbor_parts_;
  double seconds_ = 0;  // of the last tick
};

}  // namespace limber
