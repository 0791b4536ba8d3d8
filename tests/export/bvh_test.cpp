// BVH writer: angles compared with matrices; files checked by independent forward kinematics and by assimp.
#include "export/writers.h"

#include <map>
#include <sstream>

#include "base/random.h"
#include "export/loaded.h"
#include "export/rig.h"

namespace limber::exporter::test {
namespace {

using BvhTest = MotionTest;

Mat3 rotated(const Vec3& zxy) {
  const auto matrix = [](const Vec3& axis, double angle) { return glm::mat3_cast(quat_axis(axis, angle)); };
  return matrix({0, 0, 1}, zxy.x) * matrix({1, 0, 0}, zxy.y) * matrix({0, 1, 0}, zxy.z);
}

double max_distance(const Mat3& a, const Mat3& b) {
  double max = 0;
  for (int i = 0; i < 3; i++) max = std::max(max, glm::length(a[i] - b[i]));
  return max;
}

// a minimal parser of BVH files
struct Skeleton {
  struct Joint {
    std::string name;
    int parent = -1;
    Vec3 offset{0};
    std::vector<std::string> channels;
  };
  std::vector<Joint> joints;  // including End Sites
  std::size_t frames = 0;
  double frame_time = 0;
  std::vector<std::vector<double>> frame_values;

  explicit Skeleton(const std::string& text) {
    std::istringstream in(text);
    std::vector<int> open;
    std::string word;
    for (in >> word; word != "MOTION" && in; in >> word) {
      if (word == "ROOT" || word == "JOINT" || word == "End") {
        joints.push_back({"", open.empty() ? -1 : open.back(), Vec3(0), {}});
        in >> joints.back().name;
        open.push_back(static_cast<int>(joints.size()) - 1);
      } else if (word == "OFFSET") {
        in >> joints.back().offset.x >> joints.back().offset.y >> joints.back().offset.z;
      } else if (word == "CHANNELS") {
        std::size_t count = 0;
        in >> count;
        joints.back().channels.resize(count);
        for (std::string& channel : joints.back().channels) in >> channel;
      } else if (word == "}") {
        open.pop_back();
      }
    }
    EXPECT_TRUE(open.empty());
    in >> word >> frames >> word >> word >> frame_time;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::istringstream numbers(line);
      frame_values.emplace_back();
      for (double value = 0; numbers >> value;) frame_values.back().push_back(value);
    }
  }

  // poses of a frame by joint name, Y up; a position channel replaces the offset
  std::map<std::string, std::pair<Vec3, Mat3>> at(std::size_t frame) const {
    std::vector<std::pair<Vec3, Mat3>> world;
    std::map<std::string, std::pair<Vec3, Mat3>> by_name;
    std::size_t next = 0;
    for (const Joint& joint : joints) {
      Vec3 position = joint.offset;
      Mat3 rotation(1);
      for (const std::string& channel : joint.channels) {
        const double value = frame_values[frame][next++];
        const int axis = channel[0] - 'X';
        if (channel.ends_with("position")) {
          position[axis] = value;
        } else {
          Vec3 about(0);
          about[axis] = 1;
          rotation = rotation * glm::mat3_cast(quat_axis(about, value * kPi / 180));
        }
      }
      if (joint.parent >= 0) {
        const auto& [p, r] = world[static_cast<std::size_t>(joint.parent)];
        position = p + r * position;
        rotation = r * rotation;
      }
      world.emplace_back(position, rotation);
      by_name[joint.name] = world.back();
    }
    EXPECT_EQ(next, frame_values[frame].size());
    return by_name;
  }
};

Vec3 y_up(const Vec3& v) { return {v.x, v.z, -v.y}; }
const Mat3 kUpright = glm::mat3_cast(quat_axis({1, 0, 0}, -kPi / 2));

TEST(BvhAngles, ReproduceTheRotation) {
  Random random(1, "bvh");
  for (int i = 0; i < 2000; i++) {
    const Quat q = quat_axis(random.direction(), random.uniform(-kPi, kPi));
    const Vec3 before(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    EXPECT_LT(max_distance(rotated(bvh_angles(q, before)), glm::mat3_cast(q)), 1e-9);
  }
  // the order of rotations: 90 degrees about z, then 0.5 rad about x of the rotated frame
  const Vec3 zx = bvh_angles(quat_axis({0, 0, 1}, kPi / 2) * quat_axis({1, 0, 0}, 0.5), Vec3(0));
  EXPECT_LT(glm::length(zx - Vec3(kPi / 2, 0.5, 0)), 1e-9);
}

TEST(BvhAngles, NeverJump) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    Vec3 before(0);
    for (int i = 1; i <= 1000; i++) {
      const Vec3 now = bvh_angles(quat_axis(axis, 0.05 * i), before);
      ASSERT_LT(glm::length(now - before), 0.06) << i;
      before = now;
    }
    EXPECT_NEAR(std::abs(before.x) + std::abs(before.y) + std::abs(before.z), 50, 1e-6) << "eight full turns";
  }
  // gimbal lock: the previous angles select the solution
  const Quat up = quat_axis({0, 0, 1}, 0.3) * quat_axis({1, 0, 0}, kPi / 2) * quat_axis({0, 1, 0}, 0.2);
  EXPECT_LT(glm::length(bvh_angles(up, {0.3, 1.5, 0.2}) - Vec3(0.3, kPi / 2, 0.2)), 1e-6);
}

TEST_F(BvhTest, ForwardKinematicsMatchTheLinks) {
  const auto writer = opened(make_bvh_writer(path("arm.bvh"), 50));
  const MotionBody body = three_links("arm");
  ASSERT_EQ(error_text(writer->add_body(body)), "");
  std::vector<MotionSample> truth;
  for (int i = 0; i <= 100; i++) {
    truth.push_back(posed(0.1 * i, std::sin(i), {0.01 * i, 2, 3}, 0.05 * i));
    truth.back().links[2].position.z += 1e-3 * i;  // joints may have position errors
    ASSERT_EQ(error_text(writer->add_frame(i / 50.0, std::vector{truth.back()})), "");
  }
  ASSERT_EQ(error_text(writer->finish()), "");
  const Skeleton skeleton(text("arm.bvh"));
  ASSERT_EQ(skeleton.joints.size(), 4u) << "three links and an End Site";
  EXPECT_EQ(skeleton.frames, 101u);
  EXPECT_EQ(skeleton.frame_values.size(), 101u);
  EXPECT_NEAR(skeleton.frame_time, 0.02, 1e-9);
  EXPECT_EQ(skeleton.joints[0].channels,
            (std::vector<std::string>{"Xposition", "Yposition", "Zposition", "Zrotation", "Xrotation", "Yrotation"}));
  EXPECT_LT(glm::length(skeleton.joints[1].offset - Vec3(0, 0.5, 0)), 1e-6) << "above the base, Y up";
  EXPECT_LT(glm::length(skeleton.joints[2].offset - Vec3(0.3, 0, 0)), 1e-6);
  const Loaded loaded(path("arm.bvh"));
  for (const std::size_t frame : {0u, 37u, 100u}) {
    auto at = skeleton.at(frame);
    for (std::size_t i = 0; i < 3; i++) {
      const std::string& name = body.links[i].name;
      const Vec3 place = y_up(truth[frame].links[i].position);
      EXPECT_LT(glm::length(at[name].first - place), 1e-5) << frame << name;
      const Mat3 turn = kUpright * glm::mat3_cast(truth[frame].links[i].rotation);
      EXPECT_LT(max_distance(at[name].second * kUpright * glm::mat3_cast(body.links[i].rest.rotation), turn), 1e-5)
          << frame << name;
      EXPECT_LT(glm::length(loaded.pose(name, static_cast<unsigned>(frame)).position - place), 1e-4) << frame << name;
    }
  }
}

TEST_F(BvhTest, WritesOneFileOfEqualLengthPerBody) {
  const auto writer = opened(make_bvh_writer(path("out"), 50));
  ASSERT_EQ(error_text(writer->add_body(three_links("one/two"))), "");
  ASSERT_EQ(error_text(writer->add_frame(0, std::vector{posed(0, 0)})), "");
  ASSERT_EQ(error_text(writer->add_frame(1, std::vector{posed(1, 0)})), "");
  ASSERT_EQ(error_text(writer->add_body(three_links("one:two"))), "");
  ASSERT_EQ(error_text(writer->add_body(three_links("größe"))), "");
  ASSERT_EQ(error_text(writer->add_frame(2, std::vector{absent(), posed(2, 0), posed(5, 0)})), "");
  ASSERT_EQ(error_text(writer->add_frame(3, std::vector{absent(), posed(3, 0), posed(6, 0)})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  EXPECT_EQ(files("out"), (std::vector<std::string>{"größe.bvh", "one_two-2.bvh", "one_two.bvh"}));
  const std::map<std::string, std::vector<double>> turns = {
      {"one_two", {0, 1, 1, 1}}, {"one_two-2", {2, 2, 2, 3}}, {"größe", {5, 5, 5, 6}}};
  for (const auto& [name, shoulder] : turns) {
    const Skeleton skeleton(text("out/" + name + ".bvh"));
    ASSERT_EQ(skeleton.frames, 4u);
    ASSERT_EQ(skeleton.frame_values.size(), 4u);
    for (std::size_t i = 0; i < 4; i++)
      EXPECT_LT(glm::length(skeleton.at(i)["tip"].first - y_up(posed(shoulder[i], 0).links[2].position)), 1e-5) << name;
  }
}

TEST_F(BvhTest, SeveralRootLinksGetACommonRoot) {
  MotionBody body = three_links("two trees");
  body.links.push_back({"a part", -1, Pose{{2, 0, 0}}, nullptr});
  body.links.push_back({"a part", 3, Pose{{2, 1, 0}}, nullptr});
  MotionSample sample = posed(0.5, 0.5);
  sample.links.push_back({{5, 6, 7}, quat_axis({0, 1, 0}, 1)});
  sample.links.push_back(sample.links.back() * Pose{{0, 1, 0}});
  const auto writer = opened(make_bvh_writer(path("two.bvh"), 50));
  ASSERT_EQ(error_text(writer->add_body(body)), "");
  ASSERT_EQ(error_text(writer->add_frame(0, std::vector{sample})), "");
  ASSERT_EQ(error_text(writer->finish()), "");
  const Skeleton skeleton(text("two.bvh"));
  auto at = skeleton.at(0);
  EXPECT_EQ(skeleton.joints[0].name, "two_trees") << "names are one word";
  EXPECT_LT(glm::length(at["two_trees"].first), 1e-9);
  EXPECT_LT(glm::length(at["tip"].first - y_up(sample.links[2].position)), 1e-5);
  EXPECT_LT(glm::length(at["a_part"].first - y_up(sample.links[3].position)), 1e-5);
  EXPECT_LT(glm::length(at["a_part-2"].first - y_up(sample.links[4].position)), 1e-5) << "names are unique";
}

TEST_F(BvhTest, RejectsASecondBodyInOneFile) {
  {
    const auto writer = opened(make_bvh_writer(path("a.bvh"), 50));
    ASSERT_EQ(error_text(writer->add_body(three_links("one"))), "");
    EXPECT_EQ(error_text(writer->add_body(three_links("two"))),
              path("a.bvh") +
                  ": a BVH file contains one body, but 'two' was added. Choose one with --body, or give the name of a "
                  "folder, without .bvh");
  }
  {
    const auto writer = opened(make_bvh_writer(path("none"), 50));
    ASSERT_EQ(error_text(writer->add_frame(0, {})), "");
    EXPECT_EQ(error_text(writer->finish()), path("none") + ": there is no body to write");
  }
  {
    const auto writer = opened(make_bvh_writer(path("left"), 50));
    ASSERT_EQ(error_text(writer->add_body(three_links("one"))), "");
    ASSERT_EQ(error_text(writer->add_frame(0, std::vector{posed(0, 0)})), "");
  }
  EXPECT_EQ(files(), std::vector<std::string>{}) << "no partial file is left";
}

}  // namespace
}  // namespace limber::exporter::test
