// Tendons: fixed ones are weighted sums of joint values, for actuators and equalities.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxTendonJoints = 100;
constexpr double kMaxFactor = 1e6;

}  // namespace

void MjcfFileReader::read_tendons(const MjcfElement& section) {
  constexpr std::array<std::string_view, 2> kKinds{"fixed", "spatial"};
  for (const MjcfElement& e : section.children) {
    if (e.name == "fixed") {
      read_fixed_tendon(e);
    } else if (e.name == "spatial") {
      spatial_tendons_.read(e, [this](const MjcfElement& point) -> std::optional<TendonModel::Point> {
        const Site* const site = site_named(point, "site");
        if (site == nullptr) return {};
        return TendonModel::Point{site->body, site->site.pose.position};
      });
    } else {
      reader_.unknown(e, fmt::format("<{}> in <tendon> ignored: it is not a tendon", printable_excerpt(e.name)), kKinds,
                      "Use fixed or spatial.");
    }
  }
}

void MjcfFileReader::read_fixed_tendon(const MjcfElement& element) {
  reader_.check_attributes(element);
  const MjcfClass cls = reader_.class_of(element, 0);
  std::vector<TendonJoint> joints;
  for (const MjcfElement& e : element.children) {
    if (e.name != "joint") {
      reader_.unsupported(e, fmt::format("<{}> in <fixed> ignored: it is not a joint", printable_excerpt(e.name)),
                          "Write <joint joint=\"…\" coef=\"…\"/>.", Severity::warning);
      continue;
    }
    reader_.check_attributes(e, "joint of a tendon");
    MjcfJoint* const joint = joint_named(e, "joint", "in <fixed>");
    if (joint == nullptr || joints.size() >= kMaxTendonJoints) continue;
    joints.push_back({joint, std::clamp(reader_.number(e, 0, "coef", 1), -kMaxFactor, kMaxFactor)});
  }
  const auto pulls = [&](const char* attribute) {
    const std::string* const text = reader_.text(element, cls, attribute);
    return text != nullptr && read_number(trimmed(*text)).value != 0;
  };
  if (pulls("stiffness") || pulls("damping") || pulls("frictionloss") ||
      reader_.limited(element, cls, "limited", "range")) {
    reader_.unsupported(element, "stiffness, damping, friction and limits of <fixed> in <tendon> ignored",
                        "Set those of its joints.", Severity::warning);
  }
  if (const std::string* const name = element.attribute("name")) fixed_tendons_.try_emplace(*name, std::move(joints));
}

}  // namespace limber::model
