// Touch: normal force of the contacts in a region of a part.
#include <memory>
#include <string>
#include <utility>

#include "sim/sensors/sensing.h"
#include "sim/sensors/sensor.h"
#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::sim {

namespace {

using namespace properties;

struct TouchProperties {
  const Property *position, *radius, *count, *force;
};

const TouchProperties& touch_properties() {
  static const auto at = [](const char* name) { return &touch_table().at(name); };
  static const TouchProperties found{at("position"), at("radius"), at("count"), at("force")};
  return found;
}

class Touch final : public Sensor {
 public:
  Touch(Part& part, NodeId group, std::string name) : Sensor(SensorKind::touch, part, group, std::move(name)) {}

  void end_tick(Sensing& sensing) override {
    const TouchProperties& properties = touch_properties();
    const double radius = *setting(*properties.radius);
    const Vec3 center = place(*properties.position);
    const ContactPoints& points = sensing.contacts().points();
    double impulse = 0;
    int count = 0;
    for (const PartContact& contact : points.of(part().id())) {
      const ContactPoint& point = points.list()[contact.point];
      if (radius > 0 && glm::length(point.position - center) > radius) continue;
      impulse += point.impulse;
      count += static_cast<int>(point.in_use);
    }
    publish(*properties.count, count);
    publish(*properties.force, impulse / points.seconds());
  }
};

}  // namespace

const PropertyTable& touch_table() {
  static const PropertyTable table(
      "touch", "/physics/body/<body>/sensor/<touch>", "",
      {
          vec3("position", "m", {0, 0, 0}, -1e4, 1e4, "Center of its region in the part's link frame."),
          number("radius", "m", 0, 0, 1e6, "Radius of its region; 0: the whole part."),
          transient(readout(integer("count", 0, 0, kUnbounded, "Number of contact points in the region."))),
          transient(readout(number("force", "N", 0, 0, kUnbounded,
                                   "Sum of the normal forces in the region, mean of the last tick."))),
      });
  return table;
}

std::unique_ptr<Sensor> create_touch(Part& part, NodeId group, std::string name) {
  return std::make_unique<Touch>(part, group, std::move(name));
}

}  // namespace limber::sim
