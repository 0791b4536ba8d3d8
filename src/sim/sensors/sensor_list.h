// SensorList: the sensors of a body, in order of creation. [sim]
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim/sensors/sensor.h"
#include "sim/world/object_list.h"

namespace limber::sim {

class SensorList {
 public:
  explicit SensorList(Body& body) : body_(body) {}

  std::span<const std::unique_ptr<Sensor>> list() const {
    return sensors_ ? sensors_->list() : std::span<const std::unique_ptr<Sensor>>();
  }
  Sensor* find(std::string_view name) const { return sensors_ ? sensors_->find(name) : nullptr; }
  /// Adds a sensor to a part of the body; a touch sensor makes the part report contacts. Errors: the name is taken or
  /// can't be printed, a part of another body.
  Result<Sensor*> add(std::string name, SensorKind kind, Part& part);
  /// Adds one without checks.
  Sensor& add_copy(const Sensor& source, Part& part);
  void clear() { sensors_.reset(); }
  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  Sensor& add_unchecked(SensorKind kind, Part& part, std::string name);

  Body& body_;
  std::optional<ObjectList<Sensor>> sensors_;  // its node is added with the first sensor
};

}  // namespace limber::sim
