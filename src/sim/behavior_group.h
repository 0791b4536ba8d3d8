// BehaviorGroup: one behaviour on several bodies, an instance a body, all under one name. Bodies that come and go
// become members and cease to be. What is written to the group goes to every member. [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/behavior.h"
#include "sim/neighbors.h"

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
  std::span<Part* const> neighbor_parts() const { return neighbors_->parts(); }
  NeighborSet& neighbors() const { return *neighbors_; }
  /// For types that step all members at once, laid out in a row: which members run in this step, and of each of all
  /// members where its parameters' numbers and its parts are.
  struct Layout {
    std::vector<std::uint32_t> values;      ///< In Store::kept(): of the first parameter, the others follow.
    std::vector<std::uint32_t> first_part;  ///< In `parts`; one more behind the last.
    std::vector<Part*> parts;
    std::vector<std::uint32_t> load;     ///< In World::loads(), of each of `parts`.
    std::vector<std::uint32_t> mass;     ///< In Store::kept(), of each of `parts`.
    std::vector<double> least_inertia;   ///< Its least principal moment for 1 kg, m², of each of `parts`.
    std::vector<std::uint32_t> enabled;  ///< In Store::live(): its body's row.
  };
  const Layout& layout() const { return layout_; }
  std::span<const std::uint32_t> running() const { return running_numbers_; }
  /// Another number whenever members may be others, or may have been started, since.
  std::uint64_t prepared() const { return prepared_; }
  /// Seconds of the last tick, spread over the members.
  double seconds_a_member() const;

  std::uint64_t state_hash(std::uint64_t start) const;

 private:
  friend class Behavior;
  friend class BehaviorList;
  friend class BehaviorUndo;
  friend class WorldKey;
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
  void lay_out();
  void prepare_members();
  void step(double dt);
  Result<void> names_exist() const;
  void read_time(double* out) const;
  void read_place(double* out) const;
  void write_place(const double* in);
  Result<void> refuse_place(const double* in) const;
  Result<void> act_remove(std::span<const double> args);

  World& world_;
  NodeId id_;
  std::shared_ptr<const BehaviorType> type_;
  GroupSetup setup_;
  std::shared_ptr<const BehaviorSetup> member_setup_;
  std::vector<std::unique_ptr<Behavior>> members_;
  Layout layout_;
  bool laid_out_ = false;  // false: members or their parts have changed since
  std::uint64_t prepared_ = 0;
  bool attention_ = true;                       // a member starts, or has an error
  std::uint64_t seed_ = Behavior::kNoSeed;      // of the step before
  std::vector<Behavior*> running_;              // members that run in this step
  std::vector<std::uint32_t> running_numbers_;  // their places in members_
  std::vector<NodeId> left_;                    // bodies whose instance was taken away by hand
  std::shared_ptr<NeighborSet> neighbors_;
  double seconds_ = 0;       // of the last tick
  std::uint32_t place_ = 0;  // as BehaviorList last counted it
};

}  // namespace limber
