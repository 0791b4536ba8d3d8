// The reader of BVH files gets the poses back that the export has written.
#include "export/rig.h"
#include "export/writers.h"
#include "model/mocap/bvh.h"

namespace limber::exporter::test {
namespace {

using BvhReader = MotionTest;

TEST_F(BvhReader, ReadsOurExport) {
  Result<std::unique_ptr<MotionWriter>> writer = make_bvh_writer(path("arm.bvh"), 50);
  ASSERT_TRUE(writer.ok());
  const MotionBody body = three_links("arm");
  ASSERT_TRUE((*writer)->add_body(body).ok());
  std::vector<MotionSample> truth;
  for (int i = 0; i <= 50; i++) {
    truth.push_back(posed(0.1 * i, std::sin(i), {0.01 * i, 2, 3}, 0.05 * i));
    ASSERT_TRUE((*writer)->add_frame(i / 50.0, std::vector{truth.back()}).ok());
  }
  ASSERT_TRUE((*writer)->finish().ok());
  const auto clip = model::parse_bvh(text("arm.bvh"), "arm.bvh");
  ASSERT_TRUE(clip.ok()) << clip.error();
  ASSERT_EQ((*clip)->joints.size(), 3u);
  EXPECT_EQ((*clip)->frames, 51u);
  EXPECT_NEAR((*clip)->duration(), 1, 1e-6);
  for (std::size_t frame = 0; frame < truth.size(); frame++) {
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < 3; i++) {
      const int parent = (*clip)->joints[i].parent;
      const Pose local = (*clip)->local_pose(i, frame);
      poses.push_back(parent < 0 ? local : poses[static_cast<std::size_t>(parent)] * local);
      // the file has Y up: (x, y, z) is (x, −z, y) on stage
      const Vec3 at = poses[i].position;
      EXPECT_LT(glm::length(Vec3(at.x, -at.z, at.y) - truth[frame].links[i].position), 1e-5) << frame << " " << i;
    }
  }
}

}  // namespace
}  // namespace limber::exporter::test
