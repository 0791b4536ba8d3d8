// RangeFinder: distance to the nearest part along a ray from a place on a part.
#include <memory>
#include <string>
#include <utility>

#include "base/memory/archive.h"
#include "sim/sensors/sensing.h"
#include "sim/sensors/sensor.h"
#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::sim {

namespace {

using namespace properties;

struct RangeFinderProperties {
  const Property *position, *direction, *range, *sees_own_body, *hit, *distance, *hit_position, *hit_normal;
};

const RangeFinderProperties& range_finder_properties() {
  static const auto at = [](const char* name) { return &range_finder_table().at(name); };
  static const RangeFinderProperties found{at("position"), at("direction"), at("range"),        at("sees_own_body"),
                                           at("hit"),      at("distance"),  at("hit_position"), at("hit_normal")};
  return found;
}

class RangeFinder final : public Sensor {
 public:
  RangeFinder(Part& part, NodeId group, std::string name)
      : Sensor(SensorKind::range_finder, part, group, std::move(name)) {}

  NodeId other() const override { return other_; }

  void end_tick(Sensing& sensing) override {
    const RangeFinderProperties& properties = range_finder_properties();
    const Vec3 from = place(*properties.position);
    const Vec3 direction = part().pose().rotation * normalized(vec3_at(setting(*properties.direction)));
    const double range = *setting(*properties.range);
    const bool sees_own_body = *setting(*properties.sees_own_body) != 0;
    std::optional<RayHit> hit;
    // a morph between opposite directions passes through zero
    if (direction != Vec3(0))
      hit = sensing.parts().ray(from, direction, range, {sees_own_body ? nullptr : &body(), &part()});
    other_ = hit ? hit->part->id() : NodeId{};
    publish(*properties.hit, hit ? 1 : 0);
    publish(*properties.distance, hit ? hit->distance : range);
    publish(*properties.hit_position, hit ? hit->position : from + range * direction);
    publish(*properties.hit_normal, hit ? hit->normal : Vec3(0));
  }

  void serialize(Archive& archive) override { archive.serialize(other_); }

 private:
  NodeId other_;
};

Result<void> validate_direction(const Sensor&, const double* in) {
  if (glm::length(vec3_at(in)) > 1e-9) return {};
  return Error{"the direction of a range finder must not be zero"};
}

}  // namespace

const PropertyTable& range_finder_table() {
  static const PropertyTable table(
      "range_finder", "/physics/body/<body>/sensor/<range_finder>", "",
      {
          vec3("position", "m", {0, 0, 0}, -1e4, 1e4, "Start of the ray in the part's link frame."),
          validated_by<&validate_direction>(
              vec3("direction", "", {1, 0, 0}, -1, 1, "Direction of the ray in the part's link frame; not zero.")),
          number("range", "m", 10, 0, 1e6, "Length of the ray."),
          boolean("sees_own_body", false, "Whether it sees other parts of its own body; never its own part."),
          transient(readout(boolean("hit", false, "True if it sees a part."))),
          transient(readout(number("distance", "m", 0, 0, kUnbounded, "Distance to the part seen; none: the range."))),
          transient(readout(vec3("hit_position", "m", {0, 0, 0}, -kUnbounded, kUnbounded,
                                 "The point seen, world; none: the end of the ray."))),
          transient(readout(
              vec3("hit_normal", "", {0, 0, 0}, -1, 1, "Normal of the surface at that point, world; none: zeros."))),
      });
  return table;
}

std::unique_ptr<Sensor> create_range_finder(Part& part, NodeId group, std::string name) {
  return std::make_unique<RangeFinder>(part, group, std::move(name));
}

}  // namespace limber::sim
