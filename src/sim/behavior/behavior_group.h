// BehaviorGroup: one behavior for several bodies, with an instance per body, all under one name. Members are added
// and removed with their bodies. Values set on the group are set on every member. [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/behavior/behavior.h"
#include "sim/neighbors/neighbor_set.h"

namespace limber::sim {

/// The targets of a group. Neighbors are parts of all bodies that it selects; its own parts may be among them.
struct GroupSetup {
  Selection bodies;
  Selection parts;
  Selection neighbor_parts;  ///< Default: the same as `parts`.
  bool operator==(const GroupSetup&) const = default;
};

/// A behavior or a group that was removed from BehaviorList, with the places to insert it again.
struct RemovedBehavior;

class BehaviorGroup {
 public:
  /// Callback after a property of a group was set: sets it on all members.
  static void set_on_members(void* object, const Property& property);

  /// Adds its node. BehaviorList adds members by update_members().
  BehaviorGroup(World& world, NodeId parent, std::string name, std::shared_ptr<const BehaviorType> type,
                GroupSetup setup);
  ~BehaviorGroup();
  BehaviorGroup(const BehaviorGroup&) = delete;
  BehaviorGroup& operator=(const BehaviorGroup&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  const BehaviorType& type() const { return *type_; }
  const GroupSetup& setup() const { return setup_; }
  World& world() const { return world_; }
  /// In the order in which they were added.
  std::span<const std::unique_ptr<Behavior>> members() const { return members_; }
  /// Candidate neighbors of all members, in stream order; a member skips those of its own body.
  std::span<Part* const> neighbor_parts() const { return neighbors_->parts(); }
  NeighborSet& neighbors() const { return *neighbors_; }
  /// Data layout for types that step all members at once: for each member of the group, the location of its
  /// parameters and of its parts, in contiguous arrays.
  struct Layout {
    /// Index of the first parameter in the store's persistent values; the others follow it.
    std::vector<std::uint32_t> values;
    std::vector<std::uint32_t> first_part;  ///< Index in `parts`; one more than the number of members.
    std::vector<Part*> parts;
    std::vector<std::uint32_t> accumulator;  ///< For each of `parts`, index in World::force_accumulators().
    std::vector<std::uint32_t> mass;         ///< For each of `parts`, index in the store's persistent values.
    std::vector<double> min_inertia;         ///< For each of `parts`, the least principal moment for 1 kg, m².
    std::vector<std::uint32_t> enabled;      ///< Index of the body's `enabled` in the store's transient values.
  };
  const Layout& layout() const { return layout_; }
  /// Indices in members() of the members that run in this step, ascending.
  std::span<const std::uint32_t> running_indices() const { return running_indices_; }
  /// A version that changes whenever the members may have changed or been started.
  std::uint64_t members_version() const { return members_version_; }
  /// Duration of its step in the last tick, in microseconds.
  double step_microseconds() const { return 1e6 * step_seconds_; }
  /// Duration of the last tick in seconds, divided by the number of members.
  double seconds_per_member() const;

  std::uint64_t state_hash(std::uint64_t start) const;

  // Called by BehaviorList, Behavior and BehaviorTransaction. [sim]
  /// Checks that every named body exists and has every named part. If bodies are selected by a pattern, one of them
  /// must have the part.
  Result<void> check_names() const;
  /// Updates members and neighbors after bodies were added, removed or changed. The error names a missing body or
  /// part.
  Result<void> update_members();
  Behavior* member_of(const Body& body) const;
  void append_member(std::unique_ptr<Behavior> member) { members_.push_back(std::move(member)); }
  /// Removes a member explicitly: its body gets no other one.
  RemovedBehavior remove_member(const Behavior& member);
  /// Undoes remove_member().
  void insert_member(RemovedBehavior removed);
  /// Releases what refers to a body that is being destroyed.
  void remove_body(const Body& body);
  /// If `type` is a newer version of its type or of that of its members, replaces these.
  void replace_type(const std::shared_ptr<const BehaviorType>& type);
  /// Steps the members that run.
  void step(double dt);
  /// The members or their parts have changed.
  void invalidate_layout() { layout_valid_ = false; }
  /// A member has to be started or has an error.
  void request_preparation() { needs_preparation_ = true; }
  /// Serializes the state of its members, for checkpoints.
  void serialize(Archive& archive);

 private:
  /// True if the selection includes the body, or it has a member already (copies of a member's body).
  bool includes(const Body& body) const;
  const Selection& neighbor_selection() const;
  Result<void> add_member(Body& body);
  void build_layout();
  void prepare_members();

  World& world_;
  NodeId id_;
  std::shared_ptr<const BehaviorType> type_;
  GroupSetup setup_;
  std::shared_ptr<const BehaviorSetup> member_setup_;
  std::vector<std::unique_ptr<Behavior>> members_;
  Layout layout_;
  bool layout_valid_ = false;  // false: members or their parts have changed since it was built
  std::uint64_t members_version_ = 0;
  bool needs_preparation_ = true;                // a member has to be started or has an error
  std::uint64_t last_seed_ = Behavior::kNoSeed;  // of the previous step
  std::vector<Behavior*> running_;               // members that run in this step
  std::vector<std::uint32_t> running_indices_;   // their indices in members_
  std::vector<NodeId> removed_bodies_;           // bodies that a member was removed from explicitly
  std::shared_ptr<NeighborSet> neighbors_;
  double step_seconds_ = 0;  // duration of the last tick
};

struct RemovedBehavior {
  std::unique_ptr<Behavior> behavior;  ///< One of the two is set.
  std::unique_ptr<BehaviorGroup> group;
  std::size_t index = 0;          ///< In the list, or among the members of its group.
  std::size_t index_on_body = 0;  ///< Among the behaviors of its body.
};

}  // namespace limber::sim
