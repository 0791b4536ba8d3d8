// Sensors: those that have an equivalent become sensors of the body.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr double kMaxRange = 1e6;  // m

// Sensors whose values are readouts of joints, motors and parts.
constexpr std::array<std::string_view, 14> kReadouts{
    "jointpos",         "jointvel", "ballquat",  "ballangvel",  "actuatorpos", "actuatorvel", "actuatorfrc",
    "jointactuatorfrc", "framepos", "framequat", "framelinvel", "frameangvel", "velocimeter", "clock"};

std::optional<SensorModel::Kind> kind_of(std::string_view element) {
  if (element == "accelerometer" || element == "gyro") return SensorModel::Kind::imu;
  if (element == "rangefinder") return SensorModel::Kind::range_finder;
  if (element == "touch") return SensorModel::Kind::touch;
  return {};
}

// The name of an IMU is that of its site.
MjcfSensor sensor_at(MjcfReader& reader, const MjcfElement& element, SensorModel::Kind kind, int body,
                     const MjcfSite& site) {
  MjcfSensor sensor;
  sensor.kind = kind;
  sensor.name = kind == SensorModel::Kind::imu ? site.name : reader.name(element);
  if (sensor.name.empty()) sensor.name = site.name;
  sensor.link = body;
  sensor.pose = site.pose;
  sensor.radius = site.radius;
  sensor.range = std::clamp(reader.number(element, 0, "cutoff", 0), 0.0, kMaxRange);
  return sensor;
}

// Adds a sensor. An accelerometer and a gyro of one site are one IMU.
void add_sensor(MjcfReader& reader, const MjcfElement& element, MjcfSensor sensor, std::vector<MjcfSensor>& sensors) {
  const auto is_same = [&](const MjcfSensor& s) { return s.name == sensor.name; };
  const auto found = std::find_if(sensors.begin(), sensors.end(), is_same);
  if (found == sensors.end()) {
    sensors.push_back(std::move(sensor));
  } else if (sensor.kind != SensorModel::Kind::imu || found->kind != sensor.kind || found->link != sensor.link) {
    reader.error(element, fmt::format("{} ignored: there is a sensor '{}' already", reader.shown(element), sensor.name),
                 "Give every sensor a name of its own.");
  }
}

}  // namespace

void MjcfFileReader::read_sensors(const MjcfElement& section) {
  for (const MjcfElement& e : section.children) {
    const std::optional<SensorModel::Kind> kind = kind_of(e.name);
    if (kind && e.attribute("site") != nullptr) {
      reader_.check_attributes(e);
      if (const Site* const found = site_named(e, "site"))
        add_sensor(reader_, e, sensor_at(reader_, e, *kind, found->body, found->site), file_.sensors);
    } else if (kind) {
      reader_.unsupported(e, fmt::format("<{}> without a site ignored: nothing is measured", e.name),
                          "Write site=\"…\" with the name of a site.", Severity::warning);
    } else if (std::find(kReadouts.begin(), kReadouts.end(), e.name) == kReadouts.end()) {
      reader_.unsupported(e, fmt::format("<{}> in <sensor> ignored: nothing is measured", printable_excerpt(e.name)),
                          "Read the properties of parts and joints instead.");
    }
  }
}

}  // namespace limber::model
