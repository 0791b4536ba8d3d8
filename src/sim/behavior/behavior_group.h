// BehaviorGroup: one behavior for several bodies, with an instance per body, all under one name. Members are added
// and removed with their bodies. Values set on the group are set on every member. [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/behavior/behavior.h"
#include "sim/neighbors/neighbor_set.h"

namespace limber {

/// The targets of a group. Neighbors are parts of all bodies that it selects; its own parts may be among them.
struct GroupSetup {
  Selection bodies;
  Selection parts;
  Selection neighbor_parts;  ///< Default: the same as `parts`.
  bool operator==(const GroupSetup&) const = default;
};

class BehaviorGroup {
 public:
  static std::vector<Property> common_properties();
  /// Callback after a property of a group was set: sets it on all members.
  static void set_on_members(void* object, const Property& property);

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
  /// Duration of the last tick in seconds, divided by the number of members.
  double seconds_per_member() const;

  std::uint64_t state_hash(std::uint64_t start) const;

 private:
  friend class Behavior;
  friend class BehaviorList;
  friend class BehaviorTransaction;
  friend class WorldCheckpoint;
  BehaviorGroup(World& world, NodeId parent, std::string name, std::shared_ptr<const BehaviorType> type,
                GroupSetup setup);

  Behavior* member_of(const Body& body) const;
  /// True if the selection includes the body, or it has a member already (copies of a member's body).
  bool includes(const Body& body) const;
  const Selection& neighbor_selection() const;
  /// Updates members and neighbors after bodies were added, removed or changed. The error names a missing body or
  /// part.
  Result<void> update_members();
  Result<Behavior*> add_member(Body& body);
  /// Replaces its type by the reloaded one of the same name; BehaviorList replaces the members.
  void set_type(const std::shared_ptr<const BehaviorType>& type);
  void build_layout();
  void prepare_members();
  void step(double dt);
  Result<void> check_names() const;
  void read_time(double* out) const;
  void read_place(double* out) const;
  void write_place(const double* in);
  Result<void> validate_place(const double* in) const;
  Result<void> act_remove(std::span<const double> args);

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
  std::uint32_t place_ = 0;  // as computed by the last BehaviorList::compute_places()
};

}  // namespace limber
