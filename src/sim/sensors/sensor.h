// Sensor: measures something at a place on a part: an IMU, a range finder, a proximity zone, or a touch sensor. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/vec.h"
#include "properties/store.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class Body;
class Part;
class Sensing;

enum class SensorKind : std::uint8_t { imu, range_finder, zone, touch };
inline constexpr std::array kSensorKinds{SensorKind::imu, SensorKind::range_finder, SensorKind::zone,
                                         SensorKind::touch};

class Sensor {
 public:
  static const PropertyTable& table(SensorKind kind);
  /// Name of the class of a kind: "range_finder".
  static const std::string& kind_name(SensorKind kind) { return table(kind).name(); }
  static std::unique_ptr<Sensor> create(SensorKind kind, Part& part, NodeId group, std::string name);

  virtual ~Sensor();
  Sensor(const Sensor&) = delete;
  Sensor& operator=(const Sensor&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const;
  SensorKind kind() const { return kind_; }
  Part& part() const { return part_; }
  Body& body() const;
  /// The part that it sees, or a null id.
  virtual NodeId other() const { return {}; }

  /// Called before forces are applied in a tick, after each substep of `h` s, and once all readouts of parts are
  /// published.
  virtual void begin_tick() {}
  virtual void end_substep(double h) { (void)h; }
  virtual void end_tick(Sensing& sensing) = 0;
  /// For checkpoints.
  virtual void serialize(Archive& archive) { (void)archive; }

 protected:
  Sensor(SensorKind kind, Part& part, NodeId group, std::string name);
  Store& store() const;
  /// Value of a setting.
  const double* setting(const Property& property) const;
  /// Writes a readout.
  void publish(const Property& property, double value);
  void publish(const Property& property, const Vec3& value);
  /// Its place, world, after the last tick.
  Vec3 place(const Property& position) const;

 private:
  SensorKind kind_;
  Part& part_;
  NodeId id_;
};

/// The kind of this name (compared as same_name() does), or none.
std::optional<SensorKind> sensor_kind_named(std::string_view name);

// The kinds; their tables and create() functions, for Sensor.
const PropertyTable& imu_table();
const PropertyTable& range_finder_table();
const PropertyTable& zone_table();
const PropertyTable& touch_table();
std::unique_ptr<Sensor> create_imu(Part& part, NodeId group, std::string name);
std::unique_ptr<Sensor> create_range_finder(Part& part, NodeId group, std::string name);
std::unique_ptr<Sensor> create_zone(Part& part, NodeId group, std::string name);
std::unique_ptr<Sensor> create_touch(Part& part, NodeId group, std::string name);

}  // namespace limber::sim
