// MocapSource: a dancer whose joints arrive as OSC messages, or are played from a BVH file. The joints are nodes
// below it. Each tick moves them towards their last samples, within its limits. [sim]
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "properties/store.h"
#include "sim/mocap/mocap_features.h"
#include "sim/mocap/mocap_joint.h"
#include "sim/mocap/mocap_messages.h"
#include "sim/mocap/mocap_setup.h"

namespace limber {
class Archive;
}  // namespace limber

namespace limber::sim {

class World;

class MocapSource {
 public:
  static const PropertyTable& table();
  static constexpr std::size_t kMaxJoints = model::BvhClip::kMaxJoints;

  /// The setup must be valid (check()).
  MocapSource(World& world, NodeId group, std::string name, std::shared_ptr<const MocapSetup> setup);
  ~MocapSource();
  MocapSource(const MocapSource&) = delete;
  MocapSource& operator=(const MocapSource&) = delete;
  /// Error: messages that can't be compiled, too many joints, names that can't be printed, bones that form a loop.
  static Result<void> check(const MocapSetup& setup);

  NodeId id() const { return id_; }
  const std::string& name() const;
  World& world() const { return world_; }
  Store& store() const;
  const std::shared_ptr<const MocapSetup>& setup() const { return setup_; }
  bool is_player() const { return setup_->clip != nullptr; }
  std::span<const std::unique_ptr<MocapJoint>> joints() const { return joints_; }
  MocapJoint* find(std::string_view name) const;
  /// Adds a joint that the source is expected to send. Errors: it is a player, the name can't be printed, too many.
  Result<MocapJoint*> expect(std::string name);

  /// Length of the bone from the parent of a joint to it: of a player in its first frame; m, without `scale`.
  double bone_length(const MocapJoint& joint) const;

  std::span<const MocapMessage> messages() const { return messages_; }
  /// Accepts a message with the mapping of that index. `joint`: the one named in the address, or empty.
  Result<void> accept(std::size_t mapping, std::span<const Arg> args, std::string_view joint);
  /// True if its samples and those of another source have just changed places: the tracking system has mixed them up.
  /// Both forget it.
  bool consume_swap(MocapSource& other);
  /// Moves the joints and publishes the readouts.
  void step(double dt);

  /// For checkpoints.
  void serialize(Archive& archive);

  // Callbacks of the properties.
  void read_number(double* out) const;
  void read_duration(double* out) const;

 private:
  MocapJoint& add_joint(std::string name);
  MocapJoint* joint_for(const MocapSample& sample, std::string_view named);
  void link_joints();
  void play(double dt);
  void publish_start();
  void move_joints(double dt);
  double trust(double age) const;
  void publish_joints(double time);
  void publish_features(double dt);
  void report(double time);
  void report_missing();
  double setting(const Property* property) const;

  World& world_;
  NodeId id_;
  NodeId joint_group_;
  std::shared_ptr<const MocapSetup> setup_;
  std::vector<MocapMessage> messages_;
  std::vector<std::unique_ptr<MocapJoint>> joints_;
  std::size_t declared_ = 0;        // number of joints of the setup, which come first
  std::vector<std::size_t> order_;  // of the joints, parents first
  MocapFeatureExtractor features_;
  std::vector<Pose> raw_;            // scratch: of the joints, in the source's frame
  std::vector<Vec3> accelerations_;  // of the previous tick
  /// Mean place of the samples on stage, and the last jump of it.
  struct SampleCenter {
    Vec3 place{0};
    Vec3 before_jump{0};
    double jumped_at = -1;  ///< s; negative: no jump
    bool known = false;
  };
  void follow_samples(const Vec3& center, double time);

  // what persists from tick to tick, besides its properties
  struct State {
    SampleCenter samples;
    double last_frame = -1;  ///< Time of the newest sample, s; negative: none yet.
    double first_frame = -1;
    double frames = 0;  ///< Number of messages that were accepted.
    double jerk = 0;
    bool lost = false;
    bool reported_missing = false;
  } state_;
};

}  // namespace limber::sim
