// SensorList: adding sensors to a body.
#include "sim/sensors/sensor_list.h"

#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "base/memory/archive.h"
#include "base/text.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

Sensor& SensorList::add_unchecked(SensorKind kind, Part& part, std::string name) {
  WorldTransaction& transaction = body_.world().transaction();
  if (!sensors_) {
    Store& store = body_.store();
    sensors_.emplace(store, store.add_group(body_.id(), "sensor"));
    transaction.record(
        [](void* list, std::size_t) {
          SensorList& self = *static_cast<SensorList*>(list);
          const NodeId group = self.sensors_->group();
          self.clear();
          self.body_.store().remove(group);
        },
        this);
  }
  Sensor& sensor = sensors_->add(Sensor::create(kind, part, sensors_->group(), std::move(name)));
  transaction.record_added(sensors_->objects());
  return sensor;
}

Result<Sensor*> SensorList::add(std::string name, SensorKind kind, Part& part) {
  if (const auto fault = name_error(name)) return Error{fmt::format("sensor: {}", *fault)};
  if (find(name) != nullptr) return Error{fmt::format("there is a sensor '{}' already; names are unique", name)};
  if (&part.body() != &body_) {
    return Error{fmt::format("sensor '{}/{}': the part '{}/{}' belongs to another body", body_.name(), name,
                             part.body().name(), part.name())};
  }
  if (kind == SensorKind::touch) {
    const double on = 1;
    if (const auto set = body_.store().set(part.id(), "report_contacts", {&on, 1}); !set) return Error{set.error()};
  }
  return &add_unchecked(kind, part, std::move(name));
}

Sensor& SensorList::add_copy(const Sensor& source, Part& part) {
  return add_unchecked(source.kind(), part, source.name());
}

void SensorList::serialize(Archive& archive) {
  for (const auto& sensor : list()) sensor->serialize(archive);
}

}  // namespace limber::sim
