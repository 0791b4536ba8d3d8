// F and A in the view: which parts they frame, and where the camera goes.
#include "app/view/frame_parts.h"

#include <algorithm>

#include "app/view/camera_control.h"
#include "engine/show.h"

namespace limber::app::test {
namespace {

constexpr const char* kTwoArms = R"(
sim.gravity = vec3(0, 0, 0)
local ball = sim:add_sphere_shape("ball", 0.25)
for i = 1, 2 do
  local body = sim:add_body("arm" .. i)
  body:add_part("a", ball, { position = vec3(10 * i, 0, 1), mass = 1 })
  body:add_part("b", ball, { position = vec3(10 * i, 0, 2), mass = 1 })
  body:add_joint("hinge", "a", "b", { axis = vec3(0, 1, 0) })
  body:add_motor("hinge")
  body:add_behavior("force", "push", { amp = 0 })
end
)";

class FramingRig {
 public:
  FramingRig() : file_(kTwoArms), show(file_.path()) {
    const std::uint64_t ask = show.link.request_value_snapshot();
    do {
      show.engine.idle();
      values_ = show.link.value_snapshots.read();
    } while (values_ == nullptr || values_->request < ask);
  }
  std::shared_ptr<const engine::Snapshot> now() { return show.link.snapshots.read(); }
  // x coordinates of the centers of the parts
  std::vector<double> framed(const std::string& address) {
    std::vector<double> xs;
    for (const sim::FramedSphere& sphere : spheres_of(*now(), parts_of(*values_->tree, address)))
      xs.push_back(sphere.center.x);
    std::ranges::sort(xs);
    return xs;
  }

 private:
  engine::test::SceneFile file_;
  std::shared_ptr<const engine::ValueSnapshot> values_;

 public:
  engine::test::Show show;
};

TEST(FrameParts, SelectionIsAPartOrTheBodyOfAnObject) {
  FramingRig rig;
  using Xs = std::vector<double>;
  EXPECT_EQ(rig.framed("/physics/body/arm1/part/b"), Xs({10}));
  EXPECT_EQ(rig.framed("/physics/body/arm2"), Xs({20, 20}));
  EXPECT_EQ(rig.framed("/physics/body/arm2/joint/hinge"), Xs({20, 20}));
  EXPECT_EQ(rig.framed("/physics/body/arm1/motor/hinge"), Xs({10, 10}));
  EXPECT_EQ(rig.framed("/physics/body/arm1/behavior/push"), Xs({10, 10}));
  EXPECT_EQ(rig.framed("/physics/body/*/behavior/push"), Xs({10, 10, 20, 20}));
  EXPECT_TRUE(rig.framed("/physics/sim").empty());
  EXPECT_TRUE(rig.framed("/physics/body/arm3").empty());
  EXPECT_TRUE(rig.framed("").empty());
}

TEST(FrameParts, CameraLooksAtTheSelectionFromTheSameDirection) {
  FramingRig rig;
  const auto read = [&](const char* path) {
    return Vec3(rig.show.read(path, 0), rig.show.read(path, 1), rig.show.read(path, 2));
  };
  const Vec3 before = normalized(read("/visuals/camera/eye") - read("/visuals/camera/target"));
  const engine::CameraSettings camera = engine::camera_of(*rig.now());
  const std::vector<sim::FramedSphere> all = spheres_of_all(*rig.now());
  ASSERT_EQ(all.size(), 4u);
  for (const Message& message : CameraControl::frame(camera, {all.data(), 2}, 1.5))
    rig.show.link.command_queue.push({{message}, {CommandSource::panel, 0, 0}});
  rig.show.ticks(1);
  EXPECT_NEAR(glm::length(read("/visuals/camera/target") - Vec3(10, 0, 1.5)), 0, 1e-6);
  const Vec3 after = read("/visuals/camera/eye") - read("/visuals/camera/target");
  EXPECT_NEAR(glm::length(normalized(after) - before), 0, 1e-6);
  EXPECT_LT(glm::length(after), 5);
  EXPECT_TRUE(CameraControl::frame(camera, {}, 1.5).empty());
}

TEST(FrameParts, DisabledBodiesAreNotFramed) {
  FramingRig rig;
  rig.show.send("/physics/body/arm1/enabled", 0);
  rig.show.ticks(1);
  EXPECT_EQ(spheres_of_all(*rig.now()).size(), 2u);
}

}  // namespace
}  // namespace limber::app::test
