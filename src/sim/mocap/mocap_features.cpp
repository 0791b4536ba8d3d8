// MocapFeatureExtractor: the formulas of motion features.
#include "sim/mocap/mocap_features.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_map>

#include "base/text.h"

namespace limber::sim {

namespace {

constexpr double kMinExpansion = 1e-6;  // m

// The name with its mark of the left side replaced by that of the right side; empty if it has none.
std::string mirrored_joint_name(std::string_view name) {
  constexpr std::pair<std::string_view, std::string_view> kAnywhere[] = {
      {"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}};
  for (const auto& [left, right] : kAnywhere) {
    if (const std::size_t at = name.find(left); at != std::string_view::npos)
      return std::string(name.substr(0, at)) + std::string(right) + std::string(name.substr(at + left.size()));
  }
  constexpr std::pair<std::string_view, std::string_view> kPrefixes[] = {{"l_", "r_"}, {"L_", "R_"}, {"L.", "R."}};
  constexpr std::pair<std::string_view, std::string_view> kSuffixes[] = {
      {"_l", "_r"}, {"_L", "_R"}, {".l", ".r"}, {".L", ".R"}};
  for (const auto& [left, right] : kPrefixes) {
    if (name.starts_with(left)) return std::string(right) + std::string(name.substr(left.size()));
  }
  for (const auto& [left, right] : kSuffixes) {
    if (name.ends_with(left)) return std::string(name.substr(0, name.size() - left.size())) + std::string(right);
  }
  return {};
}

}  // namespace

void MocapFeatureExtractor::find_pairs(Joints joints) {
  std::unordered_map<std::string_view, std::size_t> numbers;
  for (std::size_t i = 0; i < joints.size(); i++) numbers[joints[i]->name()] = i;
  pairs_.clear();
  for (std::size_t i = 0; i < joints.size(); i++) {
    const auto found = numbers.find(mirrored_joint_name(joints[i]->name()));
    if (found != numbers.end()) pairs_.emplace_back(i, found->second);
  }
}

// The left joints are mirrored in the plane through the center whose normal points from right to left on average.
double MocapFeatureExtractor::symmetry(Joints joints, const Vec3& center, double expansion) const {
  Vec3 across(0);
  const auto usable = [&](const auto& pair) { return joints[pair.first]->placed() && joints[pair.second]->placed(); };
  for (const auto& pair : pairs_) {
    if (usable(pair)) across += joints[pair.first]->pose().position - joints[pair.second]->pose().position;
  }
  const Vec3 normal = normalized(across);
  if (normal == Vec3(0) || expansion < kMinExpansion) return 0;
  double error = 0;
  int count = 0;
  for (const auto& pair : pairs_) {
    if (!usable(pair)) continue;
    const Vec3 left = joints[pair.first]->pose().position - center;
    const Vec3 right = joints[pair.second]->pose().position - center;
    error += glm::length(left - 2 * glm::dot(left, normal) * normal - right);
    count++;
  }
  return count == 0 ? 0 : std::clamp(1 - error / count / (2 * expansion), 0.0, 1.0);
}

MocapFeatures MocapFeatureExtractor::extract(Joints joints, std::span<const Vec3> previous_accelerations,
                                             double mean_jerk, double dt) const {
  MocapFeatures out;
  out.jerk = mean_jerk;
  int count = 0;
  double jerk = 0;
  for (std::size_t i = 0; i < joints.size(); i++) {
    const MocapJoint& joint = *joints[i];
    if (!joint.placed()) continue;
    count++;
    out.center += joint.pose().position;
    out.speed += glm::length(joint.velocity());
    jerk += glm::length(joint.acceleration() - previous_accelerations[i]) / dt;
    out.contacts += joint.on_floor() ? 1 : 0;
  }
  if (count == 0) return {};
  out.center /= count;
  out.speed /= count;
  out.jerk += (jerk / count - mean_jerk) * std::min(dt / kJerkTime, 1.0);
  for (const auto& joint : joints) {
    if (!joint->placed()) continue;
    const Vec3 from_center = joint->pose().position - out.center;
    out.expansion += glm::dot(from_center, from_center);
  }
  out.expansion = std::sqrt(out.expansion / count);
  out.symmetry = symmetry(joints, out.center, out.expansion);
  return out;
}

}  // namespace limber::sim
