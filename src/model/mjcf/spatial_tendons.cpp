// SpatialTendons: their path through sites, their springs, and the actuators that drive them.
#include "model/mjcf/spatial_tendons.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"
#include "model/mjcf/convert.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxTendons = 10'000;
constexpr double kMaxStiffness = 1e9;
constexpr double kMaxDamping = 1e6;
constexpr double kMaxLength = 1e4;
/// Stiffness of a limit of the length, N/m.
constexpr double kLimitStiffness = 1e5;

}  // namespace

void SpatialTendons::read(const MjcfElement& element, const FindSite& find_site) {
  reader_.check_attributes(element);
  const MjcfClass cls = reader_.class_of(element, 0);
  MjcfTendon tendon;
  tendon.line = reader_.line_of(element);
  read_path(element, find_site, tendon.model);
  if (tendon.model.points.size() < 2 || tendons_.size() >= kMaxTendons) {
    reader_.unsupported(element, "<spatial> in <tendon> ignored: it pulls at nothing",
                        "Write at least two <site site=\"…\"/> in it.", Severity::warning);
    return;
  }
  read_spring(element, cls, tendon.model);
  tendon.model.name = reader_.name(element);
  std::string& name = tendon.model.name;
  if (name.empty()) name = fmt::format("tendon_{}", tendons_.size() + 1);
  while (index_.contains(name)) name += '_';
  index_.emplace(name, tendons_.size());
  tendons_.push_back(std::move(tendon));
}

void SpatialTendons::read_path(const MjcfElement& element, const FindSite& find_site, TendonModel& tendon) {
  for (const MjcfElement& e : element.children) {
    if (e.name == "pulley") {
      reader_.unsupported(e, "<pulley> in <spatial> ignored: the tendon ends before it",
                          "Write a tendon for each branch.", Severity::warning);
      return;
    }
    if (e.name != "site") {
      reader_.unsupported(
          e, fmt::format("<{}> in <spatial> ignored: the tendon goes straight on", printable_excerpt(e.name)),
          "Add sites on the surface that it wraps around.", Severity::warning);
      continue;
    }
    reader_.check_attributes(e, "site of a tendon");
    const std::optional<TendonModel::Point> point = find_site(e);
    if (!point) continue;
    if (tendon.points.size() >= TendonModel::kMaxPoints) {
      reader_.unsupported(e, fmt::format("<spatial>: sites after the first {} ignored", TendonModel::kMaxPoints),
                          "Split the tendon.", Severity::warning);
      return;
    }
    tendon.points.push_back(*point);
  }
}

void SpatialTendons::read_spring(const MjcfElement& element, MjcfClass cls, TendonModel& tendon) {
  tendon.stiffness = std::clamp(reader_.number(element, cls, "stiffness", 0), 0.0, kMaxStiffness);
  tendon.damping = std::clamp(reader_.number(element, cls, "damping", 0), 0.0, kMaxDamping);
  if (const double width = reader_.number(element, cls, "width", 0); width > 0) tendon.radius = std::min(width, 10.0);
  tendon.pushes = tendon.stiffness > 0 || tendon.damping > 0;
  read_length(element, cls, tendon);
  if (reader_.number(element, cls, "frictionloss", 0) != 0) {
    reader_.unsupported(element, "friction of <spatial> in <tendon> ignored", "Increase its damping.",
                        Severity::warning);
  }
  if (reader_.limited(element, cls, "limited", "range")) read_range(element, cls, tendon);
}

// MuJoCo's springs pull and push; with two lengths, they are slack in between.
void SpatialTendons::read_length(const MjcfElement& element, MjcfClass cls, TendonModel& tendon) {
  const std::vector<double> lengths = reader_.numbers(element, cls, "springlength", 1, 2);
  if (lengths.empty() || lengths.back() < 0) return;
  tendon.rest = std::min(lengths.back(), kMaxLength);
  if (lengths.size() < 2 || lengths[0] >= lengths[1]) return;
  tendon.pushes = false;
  if (lengths[0] <= 0) return;
  reader_.unsupported(element, "<spatial>: it doesn't push below the first springlength",
                      "Set tendon.pushes in the scene to push below the second one.");
}

// Without a spring, the upper limit is a stiff cable.
void SpatialTendons::read_range(const MjcfElement& element, MjcfClass cls, TendonModel& tendon) {
  const std::vector<double> range = reader_.numbers(element, cls, "range", 2, 2);
  if (tendon.stiffness > 0 || range.empty() || !(range[1] > 0)) {
    reader_.unsupported(element, "range of <spatial> in <tendon> ignored: it has a spring",
                        "Add a second tendon in the scene.", Severity::warning);
    return;
  }
  tendon.stiffness = kLimitStiffness;
  tendon.rest = std::min(range[1], kMaxLength);
  tendon.pushes = false;
}

bool SpatialTendons::drive(const MjcfElement& element, std::string_view name) {
  const auto found = index_.find(name);
  if (found == index_.end()) return false;
  TendonModel& tendon = tendons_[found->second].model;
  if (element.name != "position") {
    reader_.unsupported(element, fmt::format("<{}> on a spatial tendon: the scene sets its force", element.name),
                        "Set tendon.tension in the scene.");
    return true;
  }
  const MjcfClass cls = reader_.class_of(element, 0);
  const std::vector<double> gears = reader_.numbers(element, cls, "gear", 1, 6);
  const double gear = gears.empty() ? 1 : gears[0];
  const double gain = std::max(reader_.number(element, cls, "kp", 1), 0.0) * gear * gear;
  const double damping = std::max(reader_.number(element, cls, "kv", 0), 0.0) * gear * gear;
  tendon.stiffness = std::min(tendon.stiffness + gain, kMaxStiffness);
  tendon.damping = std::min(tendon.damping + damping, kMaxDamping);
  tendon.pushes = true;
  reader_.unsupported(element, "<position> on a spatial tendon: kp is its stiffness, the target its rest length",
                      "Set tendon.rest_length in the scene.");
  return true;
}

void convert_tendons(const MjcfFile& file, const std::vector<int>& link_of, std::size_t root, UrdfFile& out,
                     Problems& problems) {
  if (file.tendons.empty()) return;
  const std::vector<Pose> homes = home_poses(file);
  const bool fixed_root = out.fixed_root.value_or(false);
  std::size_t others = 0;
  const MjcfTendon* first_other = nullptr;
  for (const MjcfTendon& from : file.tendons) {
    TendonModel tendon = from.model;
    bool complete = true;
    double length = 0;
    Vec3 before(0);
    for (std::size_t i = 0; i < tendon.points.size(); ++i) {
      TendonModel::Point& point = tendon.points[i];
      const auto body = static_cast<std::size_t>(point.link);
      const Vec3 place = homes[body] * point.position;
      if (i > 0) length += glm::length(place - before);
      before = place;
      point.link = link_of[body];
      if (point.link < 0 && body == 0 && fixed_root) point = {0, homes[root].inverse() * point.position};
      complete = complete && point.link >= 0;
    }
    if (!complete) {
      if (others++ == 0) first_other = &from;
      continue;
    }
    if (!tendon.rest) tendon.rest = std::min(length, kMaxLength);
    out.tendons.push_back(std::move(tendon));
  }
  if (others == 0) return;
  problems.warning(first_other->line,
                   fmt::format("{} ignored", counted(others, "tendon to a body that is not part of this tree",
                                                     "tendons to bodies that are not part of this tree")),
                   "Load with root = \"world\", so that all bodies are one body.");
}

}  // namespace limber::model
