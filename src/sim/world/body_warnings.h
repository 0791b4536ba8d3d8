// BodyWarnings: reports, once each, of settings of a body that have no effect or are limited. [sim]
#pragma once

#include <string_view>

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class Body;
class Joint;
class Part;

class BodyWarnings {
 public:
  explicit BodyWarnings(const Body& body) : body_(body) {}

  /// Warns, once per body, that setting a velocity has no effect. `subject` begins the sentence.
  void warn_static_velocity(std::string_view subject);
  /// Notes the problems of a part or joint of the body when its readouts are published. [any, one thread per body]
  void note(const Part& part);
  void note(const Joint& joint);
  /// Logs, once each, the problems noted since the last call: clamped rotations, springs with a capped stiffness,
  /// targets outside limits; and mimic joints that something keeps from the positions that their leaders demand.
  void log();
  /// For checkpoints.
  void serialize(Archive& archive);

 private:
  void warn_clamped();
  void warn_joints();

  const Body& body_;
  // what persists from tick to tick
  struct State {
    bool static_velocity = false;  // was reported
    bool clamped = false;
  } state_;
  bool is_clamped_ = false;         // the rotation of a part was clamped in this tick
  bool has_joint_problem_ = false;  // a joint may have to report a capped spring or a target outside its limits
};

}  // namespace limber::sim
