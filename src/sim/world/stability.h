// StabilityCheck: restores bodies with a part that moves faster, or farther away, than any valid scene demands, and
// bodies whose joints have come apart. [sim]
#pragma once

#include <cstdint>
#include <string>

class btRigidBody;

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class Body;
class Part;
class World;

/// Describes the instability of a part after a substep of `h` s as a predicate for a message ("is faster than …"), or
/// returns null if it is stable. Below 20000 rad/s, rotation about a driven joint's axis or a principal axis isn't
/// counted. [any, while no thread writes]
const char* find_instability(const btRigidBody& part, double h);

/// Returns the likely cause of a part's instability and a remedy, as a clause for a message.
std::string likely_cause(const Body& body, const Part& part);

class StabilityCheck {
 public:
  explicit StabilityCheck(World& world) : world_(world) {}

  /// Restores each body with an unstable part; call after each substep of `h` s. NaN and infinite values must not
  /// reach the next one, where they would spread.
  void check_parts(double h);
  /// Restores a body of which a joint came apart; call after its readouts were published.
  void check_joints(Body& body);
  /// Applies the poses of the bodies that were restored in this tick.
  void end_tick();
  /// Number of times that a body was restored or disabled since the start.
  std::uint64_t events() const { return state_.events; }
  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  void restore(Body& body, const Part& part, const std::string& instability);

  World& world_;
  // what persists from tick to tick
  struct State {
    std::uint64_t events = 0;
    bool body_restored = false;  // in this tick
  } state_;
};

}  // namespace limber::sim
