// Sensing: the contacts of a world, its sensors, the search for parts by rays and spheres, and motion capture. [sim]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/id.h"
#include "sim/sensors/part_tree.h"
#include "sim/world/contacts.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class MocapList;
class Sensor;
class World;

/// A part entered or left a zone.
struct ZoneEvent {
  NodeId zone;
  NodeId part;
};

class Sensing {
 public:
  explicit Sensing(World& world);
  ~Sensing();
  Sensing(const Sensing&) = delete;
  Sensing& operator=(const Sensing&) = delete;

  Contacts& contacts() { return contacts_; }
  const Contacts& contacts() const { return contacts_; }
  PartTree& parts() { return parts_; }
  MocapList& mocap() const { return *mocap_; }

  /// Counts the sensors; called by each.
  void note_sensor(int change) { sensor_count_ += change; }
  /// To be called before forces are applied, and after each substep of a tick. Costs nothing without sensors and parts
  /// that report contacts.
  void begin_tick();
  void end_substep(double h);
  /// To be called after the last substep.
  void end_contacts();
  /// To be called when the readouts of parts are published.
  void end_tick();

  void add_zone_event(bool enters, NodeId zone, NodeId part) {
    state_.zone_events[enters ? 0 : 1].push_back({zone, part});
  }
  /// Parts that entered zones in the last tick, or left them.
  std::span<const ZoneEvent> zone_events(bool enters) const { return state_.zone_events[enters ? 0 : 1]; }

  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  std::span<Sensor* const> sensors();

  World& world_;
  Contacts contacts_;
  PartTree parts_;
  std::unique_ptr<MocapList> mocap_;
  int sensor_count_ = 0;
  std::vector<Sensor*> sensors_;  // in the order of bodies; valid for this version of the store
  std::uint64_t structure_version_ = 0;
  // what persists from tick to tick
  struct State {
    std::array<std::vector<ZoneEvent>, 2> zone_events;  // enter, leave
  } state_;
};

}  // namespace limber::sim
