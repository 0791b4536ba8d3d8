// Zone: the parts within a sphere around a place on a part.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/memory/archive.h"
#include "sim/sensors/sensing.h"
#include "sim/sensors/sensor.h"
#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::sim {

namespace {

using namespace properties;

struct ZoneProperties {
  const Property *position, *radius, *sees_own_body, *sees_static, *count, *distance;
};

const ZoneProperties& zone_properties() {
  static const auto at = [](const char* name) { return &zone_table().at(name); };
  static const ZoneProperties found{at("position"),    at("radius"), at("sees_own_body"),
                                    at("sees_static"), at("count"),  at("distance")};
  return found;
}

class Zone final : public Sensor {
 public:
  Zone(Part& part, NodeId group, std::string name) : Sensor(SensorKind::zone, part, group, std::move(name)) {}

  NodeId other() const override { return nearest_; }

  void end_tick(Sensing& sensing) override {
    const ZoneProperties& properties = zone_properties();
    const double radius = *setting(*properties.radius);
    const bool sees_own_body = *setting(*properties.sees_own_body) != 0;
    sensing.parts().find_near(place(*properties.position), radius, {sees_own_body ? nullptr : &body(), &part()},
                              found_);
    if (*setting(*properties.sees_static) == 0)
      std::erase_if(found_, [](const NearPart& near) { return near.part->is_static(); });
    const auto nearest = std::min_element(found_.begin(), found_.end(),
                                          [](const NearPart& a, const NearPart& b) { return a.distance < b.distance; });
    nearest_ = nearest == found_.end() ? NodeId{} : nearest->part->id();
    publish(*properties.count, static_cast<double>(found_.size()));
    publish(*properties.distance, nearest == found_.end() ? radius : std::max(nearest->distance, 0.0));
    report_changes(sensing);
  }

  void serialize(Archive& archive) override { archive.serialize_all(nearest_, inside_); }

 private:
  void report_changes(Sensing& sensing) {
    before_.swap(inside_);
    inside_.clear();
    for (const NearPart& near : found_) inside_.push_back(near.part->id());
    std::ranges::sort(inside_);
    for (const NodeId part : inside_) {
      if (!std::ranges::binary_search(before_, part)) sensing.add_zone_event(true, id(), part);
    }
    for (const NodeId part : before_) {
      if (!std::ranges::binary_search(inside_, part)) sensing.add_zone_event(false, id(), part);
    }
  }

  NodeId nearest_;
  std::vector<NodeId> inside_;  // after the last tick, sorted
  std::vector<NodeId> before_;
  std::vector<NearPart> found_;
};

}  // namespace

const PropertyTable& zone_table() {
  static const PropertyTable table(
      "zone", "/physics/body/<body>/sensor/<zone>", "",
      {
          vec3("position", "m", {0, 0, 0}, -1e4, 1e4, "Its center in the part's link frame."),
          number("radius", "m", 1, 0, 1e6, "Parts whose surface is at most this far from the center are inside."),
          boolean("sees_own_body", false, "Whether it sees other parts of its own body; never its own part."),
          boolean("sees_static", false, "Whether it sees static parts, such as the floor."),
          transient(readout(integer("count", 0, 0, kUnbounded, "Number of parts inside."))),
          transient(readout(number("distance", "m", 0, 0, kUnbounded,
                                   "Distance of the nearest surface from the center; none: the radius."))),
      });
  return table;
}

std::unique_ptr<Sensor> create_zone(Part& part, NodeId group, std::string name) {
  return std::make_unique<Zone>(part, group, std::move(name));
}

}  // namespace limber::sim
