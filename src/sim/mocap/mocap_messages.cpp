// MocapMessage: compiles the words of a mapping, and decodes messages by them.
#include "sim/mocap/mocap_messages.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::sim {

namespace {

// The words; values 0 .. 14 are slots of numbers.
enum MocapWord : std::uint8_t { kX, kQw = 3, kLocalX = 7, kLocalQw = 10, kConfidence = 14, kJointName, kSkipped };
constexpr std::array<std::string_view, 17> kWordNames{
    "x", "y", "z", "qw", "qx", "qy", "qz", "lx", "ly", "lz", "lqw", "lqx", "lqy", "lqz", "confidence", "joint", "-"};
constexpr std::size_t kNumberWords = kConfidence + 1;
constexpr std::string_view kJointSegment = "<joint>";

using Numbers = std::array<double, kNumberWords>;

Vec3 vector_at(const Numbers& n, std::size_t at) { return {n[at], n[at + 1], n[at + 2]}; }

std::optional<Vec3> position_at(const Numbers& n, std::size_t at) {
  const Vec3 v = vector_at(n, at);
  const bool valid = is_finite(v) && std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= MocapMessage::kMaxValue;
  return valid ? std::optional(v) : std::nullopt;
}

std::optional<Quat> rotation_at(const Numbers& n, std::size_t at) {
  const Quat q(n[at], n[at + 1], n[at + 2], n[at + 3]);
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!std::isfinite(length) || length < 1e-3 || length > 1e3) return std::nullopt;
  return q / length;
}

}  // namespace

Result<MocapMessage> MocapMessage::compile(const MocapMapping& mapping) {
  MocapMessage out;
  out.address_ = mapping.address;
  if (mapping.address.size() < 2 || mapping.address.front() != '/' || mapping.address.size() > 200)
    return Error{fmt::format("'{}' is not an OSC address; it starts with / and has at most 200 characters",
                             printable(mapping.address))};
  if (const std::size_t at = mapping.address.find(kJointSegment); at != std::string::npos) {
    out.has_joint_segment_ = true;
    out.before_joint_ = mapping.address.substr(0, at);
    out.after_joint_ = mapping.address.substr(at + kJointSegment.size());
  }
  for (const std::string_view word : split(mapping.words, ' ')) {
    if (word.empty()) continue;
    if (Result<void> added = out.add_word(word); !added) return Error{added.error()};
  }
  if (out.has_joint_word_ && out.has_joint_segment_)
    return Error{fmt::format("{}: the joint is named in the address and by an argument; remove one", mapping.address)};
  if (Result<void> checked = out.check_groups(); !checked) return Error{checked.error()};
  return out;
}

Result<void> MocapMessage::add_word(std::string_view word) {
  const auto found = std::ranges::find(kWordNames, word);
  if (found == kWordNames.end())
    return Error{fmt::format("{}: there is no word '{}'{}", address_, printable(word),
                             name_hint(word, std::span<const std::string_view>(kWordNames)))};
  const auto code = static_cast<std::uint8_t>(found - kWordNames.begin());
  if (code != kSkipped && std::ranges::find(words_, code) != words_.end())
    return Error{fmt::format("{}: '{}' appears twice", address_, word)};
  if (words_.size() == kMaxWords) return Error{fmt::format("{}: has more than {} words", address_, kMaxWords)};
  words_.push_back(code);
  has_joint_word_ = has_joint_word_ || code == kJointName;
  return {};
}

// A vector or a quaternion must be complete.
Result<void> MocapMessage::check_groups() const {
  struct Group {
    std::uint8_t first;
    std::ptrdiff_t size;
  };
  for (const Group group : {Group{kX, 3}, Group{kQw, 4}, Group{kLocalX, 3}, Group{kLocalQw, 4}}) {
    const auto count = std::ranges::count_if(
        words_, [&](std::uint8_t code) { return code >= group.first && code < group.first + group.size; });
    if (count != 0 && count != group.size)
      return Error{fmt::format("{}: '{}' needs all {} words of its {}", address_, kWordNames[group.first], group.size,
                               group.size == 3 ? "vector" : "quaternion")};
  }
  return {};
}

std::string_view MocapMessage::joint_in(std::string_view address) const {
  if (address.size() <= before_joint_.size() + after_joint_.size() || !address.starts_with(before_joint_) ||
      !address.ends_with(after_joint_))
    return {};
  const std::string_view joint =
      address.substr(before_joint_.size(), address.size() - before_joint_.size() - after_joint_.size());
  return joint.find('/') == std::string_view::npos ? joint : std::string_view();
}

Result<std::size_t> MocapMessage::count(std::span<const Arg> args) const {
  const std::size_t width = words_.size();
  const bool single = has_joint_word_ || has_joint_segment_;
  if (single ? args.size() < width : args.empty() || args.size() % width != 0) {
    return Error{
        fmt::format("takes {} {} arguments, got {}", single ? "at least" : "a multiple of", width, args.size())};
  }
  const std::size_t joints = single ? 1 : args.size() / width;
  for (std::size_t i = 0; i < joints * width; i++) {
    const std::uint8_t code = words_[i % width];
    if (code == kSkipped) continue;
    if (code == kJointName ? !args[i].is_text() : !args[i].is_numeric())
      return Error{fmt::format("argument {} must be a {}", i + 1, code == kJointName ? "joint's name" : "number")};
  }
  return joints;
}

MocapSample MocapMessage::decode(std::span<const Arg> args, std::size_t index) const {
  MocapSample sample;
  sample.index = index;
  Numbers numbers{};
  std::array<bool, kNumberWords> present{};
  for (std::size_t i = 0; i < words_.size(); i++) {
    const Arg& arg = args[index * words_.size() + i];
    if (words_[i] == kJointName) sample.joint = arg.text;
    if (words_[i] >= kNumberWords) continue;
    numbers[words_[i]] = arg.number;
    present[words_[i]] = true;
  }
  if (present[kX]) sample.position = position_at(numbers, kX);
  if (present[kQw]) sample.rotation = rotation_at(numbers, kQw);
  if (present[kLocalX]) sample.local_position = position_at(numbers, kLocalX);
  if (present[kLocalQw]) sample.local_rotation = rotation_at(numbers, kLocalQw);
  if (present[kConfidence] && std::isfinite(numbers[kConfidence]))
    sample.confidence = std::clamp(numbers[kConfidence], 0.0, 1.0);
  return sample;
}

}  // namespace limber::sim
