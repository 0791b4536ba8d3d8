// Sensor: the functions that all kinds share.
#include "sim/sensors/sensor.h"

#include <utility>

#include "base/text.h"
#include "sim/sensors/sensing.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

const PropertyTable& Sensor::table(SensorKind kind) {
  switch (kind) {
    case SensorKind::range_finder:
      return range_finder_table();
    case SensorKind::zone:
      return zone_table();
    case SensorKind::touch:
      return touch_table();
    case SensorKind::imu:
      break;
  }
  return imu_table();
}

std::unique_ptr<Sensor> Sensor::create(SensorKind kind, Part& part, NodeId group, std::string name) {
  switch (kind) {
    case SensorKind::range_finder:
      return create_range_finder(part, group, std::move(name));
    case SensorKind::zone:
      return create_zone(part, group, std::move(name));
    case SensorKind::touch:
      return create_touch(part, group, std::move(name));
    case SensorKind::imu:
      break;
  }
  return create_imu(part, group, std::move(name));
}

std::optional<SensorKind> sensor_kind_named(std::string_view name) {
  for (const SensorKind kind : kSensorKinds) {
    if (same_name(name, Sensor::kind_name(kind))) return kind;
  }
  return {};
}

Sensor::Sensor(SensorKind kind, Part& part, NodeId group, std::string name)
    : kind_(kind), part_(part), id_(part.body().store().add(table(kind), group, std::move(name), this)) {
  body().world().sensing().note_sensor(1);
}

Sensor::~Sensor() {
  body().world().sensing().note_sensor(-1);
  store().remove(id_);
}

Body& Sensor::body() const { return part_.body(); }
Store& Sensor::store() const { return body().store(); }
const std::string& Sensor::name() const { return store().name(id_); }

const double* Sensor::setting(const Property& property) const { return std::as_const(store()).values(id_, property); }

void Sensor::publish(const Property& property, double value) { store().transient_block(id_)[property.offset] = value; }

void Sensor::publish(const Property& property, const Vec3& value) {
  put(store().transient_block(id_) + property.offset, value);
}

Vec3 Sensor::place(const Property& position) const { return part_.pose() * vec3_at(setting(position)); }

}  // namespace limber::sim
