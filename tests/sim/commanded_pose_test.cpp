// Robots from URDF files with a fixed root, without gravity: their servos move every link to a commanded pose. The
// expected poses are products of frames, and for robots outside of the repository, if there are any, the results of
// another URDF reader.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "model/urdf/import.h"
#include "sim/stage.h"

namespace limber::sim::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kRepo = LIMBER_SOURCE_DIR;
const fs::path kData = kRepo / "../shared/data";

bool is_movable(const model::JointModel& joint) {
  return joint.type == model::JointType::revolute || joint.type == model::JointType::continuous ||
         joint.type == model::JointType::prismatic;
}

double clamped_to_limits(const model::JointModel& joint, double q) {
  return joint.limited ? std::clamp(q, joint.lower, joint.upper) : q;
}

// Computes the links' poses in the root's frame, joint by joint.
std::vector<Pose> forward_kinematics(const model::BodyModel& model, const std::vector<double>& q) {
  std::vector<Pose> pose(model.links.size());
  for (std::size_t i = 0; i < model.joints.size(); i++) {
    const model::JointModel& joint = model.joints[i];
    Pose motion;
    if (joint.type == model::JointType::prismatic) motion.position = {0, 0, q[i]};
    if (joint.type == model::JointType::revolute || joint.type == model::JointType::continuous) {
      motion.rotation = quat_axis({0, 0, 1}, q[i]);
    }
    pose[static_cast<std::size_t>(joint.child)] =
        pose[static_cast<std::size_t>(joint.parent)] * joint.frame_in_parent * motion * joint.frame_in_child.inverse();
  }
  return pose;
}

double angle_of(const Quat& q) { return 2 * std::atan2(glm::length(Vec3(q.x, q.y, q.z)), std::fabs(q.w)); }

// True if all links are within half the tested tolerance; half, so that a link that is still moving doesn't count.
bool has_arrived(const Body& body, const model::BodyModel& model, const std::vector<Pose>& expected) {
  for (std::size_t i = 0; i < model.links.size(); i++) {
    const Part* part = body.find_part(model.links[i].name);
    const Pose actual = body.pose().inverse() * part->pose();
    if (glm::length(actual.position - expected[i].position) > 5e-5) return false;
    if (angle_of(glm::inverse(expected[i].rotation) * actual.rotation) > 5e-5) return false;
  }
  return true;
}

// Checks that every link is within 1e-4 m and rad of the pose given by its joint positions.
void expect_arrival(const std::shared_ptr<const model::BodyModel>& model, std::vector<double> targets,
                    const json* reference = nullptr) {
  WorldFixture s;
  s.gravity({0, 0, 0});
  s.iterations(150);
  s.substeps(8);
  Body& body = **s.world.add_body(model, "robot", BuildOptions{});
  ASSERT_EQ(body.parts().size(), model->links.size());
  // only the final pose is tested; on the way, some of these robots would collide with themselves
  s.set(body.id(), "self_collision", {0});
  for (std::size_t i = 0; i < model->joints.size(); i++) {
    const model::JointModel& joint = model->joints[i];
    if (!is_movable(joint)) continue;
    targets[i] = clamped_to_limits(joint, targets[i]);
    Joint* joint_of_body = body.find_joint(joint.name);
    ASSERT_NE(joint_of_body, nullptr) << joint.name;
    if (joint.mimic >= 0) continue;
    joint_of_body->motor()->set_target(targets[i]);
    // some files limit the effort to 1 N·m for a load of 35 kg, which is possible but takes minutes
    s.set(joint_of_body->motor()->id(), "max_angular_force", {1e4, 1e4, 1e4});
  }
  const std::vector<Pose> expected = forward_kinematics(*model, targets);
  for (int i = 0; i < 30 && !has_arrived(body, *model, expected); i++) {
    if (i == 5) {  // as much force as necessary
      s.iterations(400);
      s.substeps(16);
    }
    s.ticks(20);
  }
  const Pose root = body.pose();
  for (std::size_t i = 0; i < model->links.size(); i++) {
    Part* part = body.find_part(model->links[i].name);
    ASSERT_NE(part, nullptr);
    const Pose actual = root.inverse() * part->pose();
    EXPECT_LT(glm::length(actual.position - expected[i].position), 1e-4) << model->name << " " << part->name();
    EXPECT_LT(angle_of(glm::inverse(expected[i].rotation) * actual.rotation), 1e-4)
        << model->name << " " << part->name();
    if (reference == nullptr) continue;
    const json& xyz = reference->at(model->links[i].name).at("xyz");
    EXPECT_LT(glm::length(actual.position - Vec3(xyz.at(0), xyz.at(1), xyz.at(2))), 1.1e-4) << part->name();
  }
}

std::shared_ptr<const model::BodyModel> import_fixed(const fs::path& file) {
  model::ImportOptions options;
  options.fixed_base = true;
  auto model = model::import_urdf(file.string(), options);
  EXPECT_TRUE(model.ok()) << file;
  return *model;
}

TEST(CommandedPose, RobotsOfTheRepositoryReachTheCommandedPose) {
  for (const char* name : {"arm6", "arm17", "worm"}) {
    const auto model = import_fixed(kRepo / "urdf" / (std::string(name) + ".urdf"));
    std::vector<double> targets;
    for (std::size_t i = 0; i < model->joints.size(); i++) targets.push_back(i % 2 == 0 ? 0.2 : -0.15);
    expect_arrival(model, targets);
  }
}

TEST(CommandedPose, ExternalRobotsReachThePoseOfAnotherReader) {
  for (const char* set : {"arms", "urdf_synthetic"}) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(kData / set / "expected", error)) {
      const std::string name = entry.path().stem().string();
      const auto model =
          import_fixed(std::string(set) == "arms" ? kData / set / name / "robot.urdf" : kData / set / (name + ".urdf"));
      const json expected = json::parse(std::ifstream(entry.path()));
      std::vector<double> targets;
      bool all_within = true;
      for (const model::JointModel& joint : model->joints) {
        const json& posed_q = expected.at("posed_q");
        const double q = posed_q.contains(joint.name) ? posed_q.at(joint.name).get<double>() : 0;
        targets.push_back(q);
        all_within = all_within && (!is_movable(joint) || clamped_to_limits(joint, q) == q);
      }
      expect_arrival(model, targets, all_within ? &expected.at("posed") : nullptr);
    }
  }
}

}  // namespace
}  // namespace limber::sim::test
