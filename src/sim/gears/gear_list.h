// GearList: the gears of a world, in order of creation; detects redundant ones. [sim]
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/gears/gear.h"
#include "sim/world/object_list.h"

namespace limber::sim {

class GearList {
 public:
  GearList(World& world, NodeId parent);

  std::span<const std::unique_ptr<Gear>> list() const { return gears_.list(); }
  Gear* find(std::string_view name) const { return gears_.find(name); }
  /// Couples the own axes of two joints: position_b = ratio·position_a + offset. Without an offset, the present
  /// positions determine it. Errors: the name is taken or can't be printed, a joint without a single axis, a ratio of
  /// 0.
  Result<Gear*> add(std::string name, Joint& joint_a, Joint& joint_b, double ratio, std::optional<double> offset = {});
  /// Removes a gear. In a guarded call it is hidden at once and destroyed when the call succeeds.
  void remove(Gear& gear);
  /// Removes the gears of a body that is to be removed.
  void remove_from(const Body& body);
  void move_to_front(const std::vector<Gear*>& first) { gears_.move_to_front(first); }
  void clear() { gears_.objects().clear(); }

  /// Requests that redundant gears are determined again before the next step.
  void mark_dirty() { state_.dirty = true; }
  /// Adds gears to Bullet's world or removes them, after detecting redundant ones.
  void update();
  /// Resets the constraints of a body's gears, because its joints were moved.
  void reset_constraints(const Body& body);
  /// Warns once about each gear that limits, locks or contacts keep from its position.
  void warn_slipping();

  /// A gear without the body that it was attached to, while that body is replaced.
  struct Detached {
    std::unique_ptr<Gear> gear;
    std::size_t index;
    std::string joint_a, joint_b;  ///< Names of joints of the replaced body; empty: the joint of another body.
  };
  /// Extracts the gears of a body, last one first.
  std::vector<Detached> detach(const Body& body);
  /// Attaches the gears to the joints of the same names of `replacement`; gears without such joints are destroyed.
  void attach(std::vector<Detached> detached, const Body& replacement);

  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  void find_redundant();

  World& world_;
  ObjectList<Gear> gears_;
  // what persists from tick to tick
  struct State {
    bool dirty = false;
  } state_;
};

}  // namespace limber::sim
