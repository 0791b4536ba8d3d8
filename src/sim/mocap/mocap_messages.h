// MocapMessage: decodes OSC messages by words that name their arguments: "x y z" is a position, "qw qx qy qz" a
// rotation, "lx ly lz" and "lqw lqx lqy lqz" those relative to the parent, "confidence" 0 .. 1, "-" an argument that is
// skipped. A message without names has these values for each joint in turn; "joint" is the name of one joint, and
// <joint> in the address stands for it. [any]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/result.h"
#include "base/vec.h"
#include "sim/mocap/mocap_setup.h"

namespace limber::sim {

/// The values of one joint in a message.
struct MocapSample {
  std::string_view joint;  ///< Its name; empty: it is given by `index`.
  std::size_t index = 0;
  std::optional<Vec3> position;  ///< In units and axes of the source, like the others.
  std::optional<Quat> rotation;
  std::optional<Vec3> local_position;
  std::optional<Quat> local_rotation;
  std::optional<double> confidence;
};

/// One mapping, compiled.
class MocapMessage {
 public:
  static constexpr std::size_t kMaxWords = 24;
  static constexpr double kMaxValue = 1e6;

  /// Error: unknown or repeated words, an incomplete vector or quaternion.
  static Result<MocapMessage> compile(const MocapMapping& mapping);

  const std::string& address() const { return address_; }
  /// True if <joint> is a part of the address.
  bool names_joint_in_address() const { return has_joint_segment_; }
  /// The joint in an address of this pattern; empty if it does not match.
  std::string_view joint_in(std::string_view address) const;
  bool ignored() const { return words_.empty(); }
  /// Number of joints in a message. Error: arguments that don't fit.
  Result<std::size_t> count(std::span<const Arg> args) const;
  /// Decodes the values of one of them. Values that are not finite, and quaternions of length 0, are omitted: this is
  /// how trackers mark joints that they don't see.
  MocapSample decode(std::span<const Arg> args, std::size_t index) const;

 private:
  Result<void> add_word(std::string_view word);
  Result<void> check_groups() const;

  std::string address_;
  std::string before_joint_, after_joint_;  // around <joint>
  bool has_joint_segment_ = false;
  bool has_joint_word_ = false;
  std::vector<std::uint8_t> words_;  // by argument
};

}  // namespace limber::sim
