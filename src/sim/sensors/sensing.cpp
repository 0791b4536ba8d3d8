// Sensing: the phases of a tick for contacts and sensors.
#include "sim/sensors/sensing.h"

#include "base/memory/archive.h"
#include "sim/bullet/island_world.h"
#include "sim/mocap/mocap_list.h"
#include "sim/sensors/sensor_list.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::sim {

Sensing::Sensing(World& world) : world_(world), parts_(world), mocap_(std::make_unique<MocapList>(world)) {}

Sensing::~Sensing() = default;

std::span<Sensor* const> Sensing::sensors() {
  if (sensor_count_ == 0) return {};
  if (const std::uint64_t version = world_.store().structure_version(); version != structure_version_) {
    sensors_.clear();
    for (const auto& body : world_.bodies()) {
      for (const auto& sensor : body->sensors().list()) sensors_.push_back(sensor.get());
    }
    structure_version_ = version;
  }
  return sensors_;
}

void Sensing::begin_tick() {
  contacts_.begin_tick();
  for (std::vector<ZoneEvent>& events : state_.zone_events) events.clear();
  for (Sensor* const sensor : sensors()) sensor->begin_tick();
}

void Sensing::end_substep(double h) {
  contacts_.collect(*world_.bullet().getDispatcher());
  for (Sensor* const sensor : sensors()) {
    if (sensor->body().in_world()) sensor->end_substep(h);
  }
}

void Sensing::end_contacts() { contacts_.end_tick(world_.store(), world_.timestep()); }

void Sensing::end_tick() {
  parts_.invalidate();
  for (Sensor* const sensor : sensors()) {
    if (sensor->body().in_world()) sensor->end_tick(*this);
  }
}

void Sensing::serialize(Archive& archive) {
  archive.serialize_all(contacts_, state_.zone_events[0], state_.zone_events[1]);
  mocap_->serialize(archive);
  if (archive.loading()) parts_.invalidate_bodies();
}

}  // namespace limber::sim
