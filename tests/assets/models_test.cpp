// The models in urdf/: masses, inertias, poses and collision shapes, compared with the construction set
// (docs/reference/models.md).
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "assets/solid.h"
#include "base/vec.h"
#include "model/body_model.h"
#include "model/urdf/import.h"

namespace limber {
namespace {

using ModelPtr = std::shared_ptr<const model::BodyModel>;

// densities of the construction set, kg/m³; balls are rubber
const std::map<std::string, double> kDensity = {
    {"base", 500},  {"link", 300}, {"link_short", 300}, {"block", 700},   {"plate", 300},
    {"trunk", 350}, {"tip", 400},  {"leg", 400},        {"segment", 500}, {"finger", 900},
};
constexpr double kBallDensity = 1000;

struct Expected {
  std::size_t links;   // after fixed ones are merged
  std::size_t joints;  // movable ones
  std::size_t merged;
  int continuous;
  int prismatic;
  bool fixed_root;
};
const std::map<std::string, Expected> kModels = {
    {"arm6", {7, 6, 0, 3, 0, true}},          // alternately twist and bend
    {"arm17", {18, 17, 0, 9, 0, true}},       // 8 sections of two joints, and a twisting tip
    {"quadruped", {13, 12, 4, 0, 0, false}},  // trunk, 4 legs of 3; the feet are fixed to the shins
    {"worm", {12, 11, 0, 0, 0, false}},
    {"hand", {19, 18, 0, 1, 1, true}},  // post, lift, turn, 4 fingers of 3, a thumb of 4
};

std::string folder() { return std::string(LIMBER_SOURCE_DIR) + "/urdf"; }

ModelPtr load(const std::string& name) {
  auto result = model::import_urdf(folder() + "/" + name + ".urdf", model::ImportOptions{});
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error());
  return result.ok() ? result.value() : std::make_shared<const model::BodyModel>();
}

int link_index(const model::BodyModel& model, std::string_view name) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (model.links[i].name == name) return static_cast<int>(i);
  }
  ADD_FAILURE() << model.name << " has no link " << name;
  return 0;
}

const model::LinkModel& link_named(const model::BodyModel& model, std::string_view name) {
  return model.links[static_cast<std::size_t>(link_index(model, name))];
}

const model::JointModel& joint_named(const model::BodyModel& model, std::string_view name) {
  for (const model::JointModel& joint : model.joints) {
    if (joint.name == name) return joint;
  }
  ADD_FAILURE() << model.name << " has no joint " << name;
  return model.joints.front();
}

// Direction in which a point behind the joint starts to move from the rest pose when the joint's value increases.
Vec3 motion_of(const model::BodyModel& model, const std::string& joint_name, const Vec3& point) {
  const model::JointModel& joint = joint_named(model, joint_name);
  const Pose frame = model.links[static_cast<std::size_t>(joint.parent)].home * joint.frame_in_parent;
  return glm::cross(frame.rotation * Vec3(0, 0, 1), point - frame.position);
}

// Mass properties of a link's visual shapes, from their geometry and density.
Moments predicted_moments(const model::LinkModel& link) {
  Moments sum;
  for (const model::PlacedShape& visual : link.visuals) {
    if (visual.shape.mesh) {
      const auto density = kDensity.find(visual.shape.mesh->name);
      EXPECT_NE(density, kDensity.end()) << link.name << " shows an unknown part " << visual.shape.mesh->name;
      if (density == kDensity.end()) continue;
      EXPECT_TRUE(is_closed(*visual.shape.mesh)) << link.name;
      sum.add(moments_of_mesh(*visual.shape.mesh, visual.origin), density->second);
    } else {
      EXPECT_EQ(visual.shape.kind, model::ShapeKind::sphere) << link.name;
      sum.add(moments_of_ball(visual.shape.radius, visual.origin.position), kBallDensity);
    }
  }
  return sum;
}

TEST(Models, AreExactlyTheOnesInTheTable) {
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (entry.path().extension() == ".urdf") found.insert(entry.path().stem().string());
  }
  std::set<std::string> known;
  for (const auto& [name, expected] : kModels) known.insert(name);
  EXPECT_EQ(found, known) << "update kModels and docs/reference/models.md when a model is added or removed";
}

TEST(Models, ImportWithoutWarningsAndWithAllJoints) {
  for (const auto& [name, expected] : kModels) {
    const ModelPtr model = load(name);
    for (const model::Problem& problem : model->problems) {
      EXPECT_EQ(problem.severity, model::Severity::note) << name << ":" << problem.line << " " << problem.text;
    }
    EXPECT_EQ(model->name, name);
    EXPECT_EQ(model->links.size(), expected.links) << name;
    EXPECT_EQ(model->joints.size(), expected.joints) << name;
    EXPECT_EQ(model->merged.size(), expected.merged) << name;
    const auto count = [&](model::JointType type) {
      return std::count_if(model->joints.begin(), model->joints.end(),
                           [&](const model::JointModel& joint) { return joint.type == type; });
    };
    EXPECT_EQ(count(model::JointType::continuous), expected.continuous) << name;
    EXPECT_EQ(count(model::JointType::prismatic), expected.prismatic) << name;
    for (const model::JointModel& joint : model->joints) {
      EXPECT_EQ(joint.limited, joint.type != model::JointType::continuous) << name << " " << joint.name;
      EXPECT_TRUE(joint.effort >= 5 && joint.effort <= 200) << name << " " << joint.name << " " << joint.effort;
      EXPECT_TRUE(joint.velocity > 0 && joint.velocity <= 12) << name << " " << joint.name << " " << joint.velocity;
      EXPECT_EQ(joint.start, 0) << name << " " << joint.name << ": the limits must include the home position";
    }
  }
}

TEST(Models, MassesMatchTheirParts) {
  for (const auto& [name, expected] : kModels) {
    const ModelPtr model = load(name);
    for (std::size_t i = 0; i < model->links.size(); ++i) {
      const model::LinkModel& link = model->links[i];
      const std::string where = name + " " + link.name;
      const Moments parts = predicted_moments(link);
      if (i == 0 && expected.fixed_root) {
        EXPECT_EQ(link.inertial.mass, 0) << where;
        continue;
      }
      EXPECT_TRUE(link.inertial.mass >= 0.05 && link.inertial.mass <= 5) << where << " " << link.inertial.mass;
      EXPECT_NEAR(link.inertial.mass, parts.volume, 1e-3 * parts.volume) << where;
      const Vec3 center = parts.first / parts.volume;
      EXPECT_LT(glm::length(link.inertial.center - center), 1e-5) << where;
      // Inertia tensor about the center: trace(S) 1 - S, with the second moment S.
      const Mat3 spread = parts.second - parts.volume * glm::outerProduct(center, center);
      const Mat3 tensor = Mat3(spread[0][0] + spread[1][1] + spread[2][2]) - spread;
      const double largest = principal_moments(tensor).z;
      for (int c = 0; c < 3; ++c) {
        EXPECT_LT(glm::length(link.inertial.tensor[c] - tensor[c]), 1e-3 * largest) << where;
      }
    }
  }
}

TEST(Models, HavePhysicalInertias) {
  for (const auto& [name, expected] : kModels) {
    const ModelPtr model = load(name);
    for (const model::LinkModel& link : model->links) {
      if (link.inertial.mass == 0) continue;
      const Vec3 moments = principal_moments(link.inertial.tensor);
      EXPECT_GT(moments.x, 0) << name << " " << link.name;
      EXPECT_GE(moments.x + moments.y, moments.z) << name << " " << link.name;
    }
  }
}

// Iterative solvers converge slowly if a light body carries a heavy one.
TEST(Models, NeighborsHaveSimilarMass) {
  for (const auto& [name, expected] : kModels) {
    const ModelPtr model = load(name);
    for (const model::JointModel& joint : model->joints) {
      const double a = model->links[static_cast<std::size_t>(joint.parent)].inertial.mass;
      const double b = model->links[static_cast<std::size_t>(joint.child)].inertial.mass;
      if (a == 0) continue;
      EXPECT_LE(std::max(a, b) / std::min(a, b), 6) << name << " " << joint.name;
    }
  }
}

// A section of scale s has the height (tube + 0.02 + 0.06) s: 0.02 is the gap below the pivot, 0.06 half a block above
// it.
TEST(Models, ArmsStandUpright) {
  const ModelPtr arm6 = load("arm6");
  const double arm6_height = 0.06 + 0.47 * (1 + 0.85 + 0.722) + 0.06 * (1 + 0.85);
  EXPECT_LT(glm::length(link_named(*arm6, "tip").home.position - Vec3(0, 0, arm6_height)), 1e-5);

  const ModelPtr arm17 = load("arm17");
  double height = 0.06;
  for (const double s : {1.0, 0.94, 0.884, 0.831, 0.781, 0.734, 0.69, 0.648}) height += (0.24 + 0.02 + 0.06) * s;
  EXPECT_LT(glm::length(link_named(*arm17, "tip").home.position - Vec3(0, 0, height)), 1e-5);

  for (const ModelPtr& arm : {arm6, arm17}) {
    for (std::size_t i = 0; i < arm->joints.size(); ++i) {
      const model::JointModel& joint = arm->joints[i];
      EXPECT_EQ(joint.name, "joint_" + std::to_string(i + 1));
      const Vec3 axis = arm->links[static_cast<std::size_t>(joint.parent)].home.rotation *
                        (joint.frame_in_parent.rotation * Vec3(0, 0, 1));
      const Vec3 expected = i % 2 == 0 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
      EXPECT_LT(glm::length(axis - expected), 1e-6) << arm->name << " " << joint.name;
    }
  }
}

// Leg segments of 0.22 m, each 0.6 rad off the vertical, and a ball of 0.032 m: the trunk is 0.3951 m above the floor.
TEST(Models, QuadrupedStandsWithItsWeightAboveItsFeet) {
  const ModelPtr dog = load("quadruped");
  double mass = 0;
  Vec3 center(0);
  for (const model::LinkModel& link : dog->links) {
    mass += link.inertial.mass;
    center += link.inertial.mass * (link.home * link.inertial.center);
  }
  center /= mass;
  EXPECT_LT(std::abs(center.x), 0.03) << "the feet are at x = ±0.18 m";
  EXPECT_LT(std::abs(center.y), 1e-6);
  ASSERT_EQ(dog->merged.size(), 4U);
  for (const model::MergedLink& foot : dog->merged) {
    const Vec3 at = dog->links[static_cast<std::size_t>(foot.link)].home * foot.offset.position;
    const Vec3 expected(foot.name.starts_with("front") ? 0.18 : -0.18,
                        foot.name.find("left") != std::string::npos ? 0.14 : -0.14, -0.44 * std::cos(0.6));
    EXPECT_LT(glm::length(at - expected), 1e-5) << foot.name;
    const auto& shapes = dog->links[static_cast<std::size_t>(foot.link)].collisions;
    const auto ball = std::find_if(shapes.begin(), shapes.end(), [](const model::PlacedShape& s) {
      return s.shape.kind == model::ShapeKind::sphere;
    });
    ASSERT_NE(ball, shapes.end()) << foot.name;
    EXPECT_NEAR(ball->shape.radius, 0.032, 1e-9);
  }
}

TEST(Models, QuadrupedMovesMirroredForEqualValues) {
  const ModelPtr dog = load("quadruped");
  for (const model::MergedLink& foot : dog->merged) {
    const Vec3 at = dog->links[static_cast<std::size_t>(foot.link)].home * foot.offset.position;
    const std::string leg = foot.name.substr(0, foot.name.size() - std::string("foot").size());
    const double outwards = at.y > 0 ? 1 : -1;
    EXPECT_GT(outwards * motion_of(*dog, leg + "hip", at).y, 0.3) << leg << ": positive lifts the leg outwards";
    EXPECT_GT(motion_of(*dog, leg + "thigh", at).x, 0.3) << leg << ": positive swings the foot to the front";
    EXPECT_GT(motion_of(*dog, leg + "knee", at).z, 0.1) << leg << ": positive folds the leg";
  }
}

TEST(Models, WormJointsAlternateSidewaysAndUp) {
  const ModelPtr worm = load("worm");
  const Vec3 tail = link_named(*worm, "tail").home * Vec3(-0.13, 0, 0);
  // Eleven pitches of 0.13 m to the middle of the tail, which is half a pitch behind its joint; then half a pitch more.
  EXPECT_LT(glm::length(tail - Vec3(-0.13 * 11.5, 0, 0)), 1e-5);
  for (int k = 1; k <= 11; ++k) {
    const Vec3 motion = motion_of(*worm, "joint_" + std::to_string(k), tail);
    if (k % 2 == 1) {
      EXPECT_LT(motion.y, -0.1) << k;
      EXPECT_NEAR(motion.z, 0, 1e-9) << k;
    } else {
      EXPECT_GT(motion.z, 0.1) << k;
      EXPECT_NEAR(motion.y, 0, 1e-9) << k;
    }
  }
}

TEST(Models, HandClosesWithPositiveAnglesAndItsLittleFingerFollows) {
  const ModelPtr hand = load("hand");
  for (const std::string finger : {"index", "middle", "ring", "little"}) {
    const Vec3 end = link_named(*hand, finger + "_tip").home * Vec3(0, 0, 0.05);
    for (const char* joint : {"_1", "_2", "_3"}) {
      // The palm faces +x.
      EXPECT_GT(motion_of(*hand, finger + joint, end).x, 0.04) << finger << joint;
    }
  }
  const Vec3 thumb = link_named(*hand, "thumb_tip").home * Vec3(0, 0, 0.05);
  EXPECT_GT(motion_of(*hand, "thumb_1", thumb).x, 0.1);

  const model::JointModel& follower = joint_named(*hand, "little_3");
  ASSERT_GE(follower.mimic, 0);
  EXPECT_EQ(hand->joints[static_cast<std::size_t>(follower.mimic)].name, "little_2");
  EXPECT_EQ(follower.mimic_multiplier, 0.8);
  const auto mimics = std::count_if(hand->joints.begin(), hand->joints.end(),
                                    [](const model::JointModel& joint) { return joint.mimic >= 0; });
  EXPECT_EQ(mimics, 1);
}

// Segments must be recognized as capsules with the scaled dimensions of the construction set, since they roll and
// slide.
TEST(Models, SegmentsAndFingersCollideAsCapsules) {
  const ModelPtr worm = load("worm");
  const ModelPtr hand = load("hand");
  const std::vector<std::tuple<const model::LinkModel*, double, double>> capsules = {
      {&link_named(*worm, "head"), 0.05, 0.05},
      {&link_named(*worm, "tail"), 0.05, 0.05},
      {&link_named(*hand, "middle_base"), 0.022, 0.09},
      {&link_named(*hand, "thumb_tip"), 0.81 * 0.022, 0.81 * 0.09},
  };
  for (const auto& [link, radius, height] : capsules) {
    ASSERT_EQ(link->collisions.size(), 1U) << link->name;
    const model::ShapeModel& shape = link->collisions.front().shape;
    EXPECT_EQ(shape.kind, model::ShapeKind::capsule) << link->name;
    EXPECT_NEAR(shape.radius, radius, 0.02 * radius) << link->name;
    EXPECT_NEAR(shape.height, height, 0.02 * height) << link->name;
  }
}

}  // namespace
}  // namespace limber
