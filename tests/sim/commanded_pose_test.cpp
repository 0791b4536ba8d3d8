// Robots from URDF files, held at their root, without weight: sent to a pose by their servos, every link gets there.
// What is expected comes from frames multiplied by hand; and where there are robots beside the checkout, from another
// reader's figures.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "model/urdf_import.h"
#include "sim/stage.h"

namespace limber::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kRepo = LIMBER_SOURCE_DIR;
const fs::path kData = kRepo / "../shared/data";

bool moves(const JointModel& joint) {
  return joint.type == JointType::revolute || joint.type == JointType::continuous || joint.type == JointType::prismatic;
}

double in_limits(const JointModel& joint, double q) {
  return joint.limited ? std::clamp(q, joint.lower, joint.upper) : q;
}

// links in the root's frame, joint by joint
std::vector<Pose> forward(const BodyModel& model, const std::vector<double>& q) {
  std::vector<Pose> pose(model.links.size());
  for (std::size_t i = 0; i < model.joints.size(); i++) {
    const JointModel& joint = model.joints[i];
    Pose move;
    if (joint.type == JointType::prismatic) move.position = {0, 0, q[i]};
    if (joint.type == JointType::revolute || joint.type == JointType::continuous) {
      move.rotation = quat_axis({0, 0, 1}, q[i]);
    }
    pose[static_cast<std::size_t>(joint.child)] =
        pose[static_cast<std::size_t>(joint.parent)] * joint.frame_in_parent * move * joint.frame_in_child.inverse();
  }
  return pose;
}

double angle_of(const Quat& q) { return 2 * std::atan2(glm::length(Vec3(q.x, q.y, q.z)), std::fabs(q.w)); }

// Half of what is asked, so that it does not just pass by.
bool has_arrived(const Body& body, const BodyModel& model, const std::vector<Pose>& expected) {
  for (std::size_t i = 0; i < model.links.size(); i++) {
    const Part* part = body.find_part(model.links[i].name);
    const Pose is = body.pose().inverse() * part->pose();
    if (glm::length(is.position - expected[i].position) > 5e-5) return false;
    if (angle_of(glm::inverse(expected[i].rotation) * is.rotation) > 5e-5) return false;
  }
  return true;
}

// Every link within 1e-4 m and rad of where its joints' angles put it.
void expect_arrival(const std::shared_ptr<const BodyModel>& model, std::vector<double> targets,
                    const json* posed = nullptr) {
  Stage s;
  s.gravity({0, 0, 0});
  s.iterations(150);
  s.substeps(8);
  Body& body = **s.world.add_body(model, "robot", BuildOptions{});
  ASSERT_EQ(body.parts().size(), model->links.size());
  // what is asked is the pose, not the way there: some of these robots would stand in their own way
  s.set(body.id(), "self_collision", {0});
  for (std::size_t i = 0; i < model->joints.size(); i++) {
    const JointModel& joint = model->joints[i];
    if (!moves(joint)) continue;
    targets[i] = in_limits(joint, targets[i]);
    Joint* made = body.find_joint(joint.name);
    ASSERT_NE(made, nullptr) << joint.name;
    if (joint.mimic >= 0) continue;
    made->motor()->set_target(targets[i]);
    // some files say 1 N·m where 35 kg are to be turned: true, but a matter of minutes
    s.set(made->motor()->id(), "max_angular_force", {1e4, 1e4, 1e4});
  }
  const std::vector<Pose> expected = forward(*model, targets);
  for (int i = 0; i < 30 && !has_arrived(body, *model, expected); i++) {
    if (i == 5) {  // as much as it needs
      s.iterations(400);
      s.substeps(16);
    }
    s.ticks(20);
  }
  const Pose root = body.pose();
  for (std::size_t i = 0; i < model->links.size(); i++) {
    Part* part = body.find_part(model->links[i].name);
    ASSERT_NE(part, nullptr);
    const Pose is = root.inverse() * part->pose();
    EXPECT_LT(glm::length(is.position - expected[i].position), 1e-4) << model->name << " " << part->name();
    EXPECT_LT(angle_of(glm::inverse(expected[i].rotation) * is.rotation), 1e-4) << model->name << " " << part->name();
    if (posed == nullptr) continue;
    const json& xyz = posed->at(model->links[i].name).at("xyz");
    EXPECT_LT(glm::length(is.position - Vec3(xyz.at(0), xyz.at(1), xyz.at(2))), 1.1e-4) << part->name();
  }
}

std::shared_ptr<const BodyModel> read(const fs::path& file) {
  ImportOptions options;
  options.fixed_base = true;
  auto model = import_urdf(file.string(), options);
  EXPECT_TRUE(model.ok()) << file;
  return *model;
}

TEST(CommandedPose, OurRobotsGoWhereTheyAreSent) {
  for (const char* name : {"arm6", "arm17", "worm"}) {
    const auto model = read(kRepo / "urdf" / (std::string(name) + ".urdf"));
    std::vector<double> targets;
    for (std::size_t i = 0; i < model->joints.size(); i++) targets.push_back(i % 2 == 0 ? 0.2 : -0.15);
    expect_arrival(model, targets);
  }
}

TEST(CommandedPose, RobotsBesideTheCheckoutGoWhereAnotherReaderHasThem) {
  for (const char* set : {"arms", "urdf_synthetic"}) {
    std::error_code fault;
    for (const auto& entry : fs::directory_iterator(kData / set / "expected", fault)) {
      const std::string name = entry.path().stem().string();
      const auto model =
          read(std::string(set) == "arms" ? kData / set / name / "robot.urdf" : kData / set / (name + ".urdf"));
      const json expected = json::parse(std::ifstream(entry.path()));
      std::vector<double> targets;
      bool all_within = true;
      for (const JointModel& joint : model->joints) {
        const json& posed_q = expected.at("posed_q");
        const double q = posed_q.contains(joint.name) ? posed_q.at(joint.name).get<double>() : 0;
        targets.push_back(q);
        all_within = all_within && (!moves(joint) || in_limits(joint, q) == q);
      }
      expect_arrival(model, targets, all_within ? &expected.at("posed") : nullptr);
    }
  }
}

}  // namespace
}  // namespace limber::test
