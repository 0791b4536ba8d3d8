// ViewportMouse without a window: its messages, and their effects on a world.
#include "app/view/viewport_mouse.h"

#include "engine/show.h"

namespace limber::app::test {
namespace {

constexpr const char* kBallScene = R"(
sim.gravity = vec3(0, 0, 0)
visuals.camera.eye = vec3(0, -10, 1)
visuals.camera.target = vec3(0, 0, 1)
visuals.camera.eye = vec3(0, -10, 1)
local body = sim:add_body("my body")
body:add_part("ball", sim:add_sphere_shape("ball", 0.5), { position = vec3(0, 0, 1), mass = 3 })
)";
const std::string kBallPath = "/physics/body/my%20body/part/ball";

class MouseRig {
 public:
  MouseRig() : file_(kBallScene), show(file_.path()) { refresh(); }

  void refresh() {
    const std::uint64_t ask = show.link.request_value_snapshot();
    do {
      show.engine.idle();
      values_ = show.link.value_snapshots.read();
    } while (values_ == nullptr || values_->request < ask);
    now_ = show.link.snapshots.read();
  }
  ViewState view() const {
    return {*now_, *values_, render::camera_matrices(engine::camera_of(*now_), 400, 400), 400, 400, clock};
  }
  void move(double x, double y) {
    panel::InputEvent event;
    event.x = x;
    event.y = y;
    mouse.event(event, view());
  }
  void button(bool down, panel::KeyMods mods = {}) {
    panel::InputEvent event;
    event.kind = panel::InputEvent::Kind::button;
    event.down = down;
    event.mods = mods;
    mouse.event(event, view());
    send();
  }
  void send() {
    for (Message& message : mouse.consume_messages())
      show.link.command_queue.push({{std::move(message)}, {CommandSource::panel, 0, 0}});
  }
  void play(int ticks) {
    for (int i = 0; i < ticks; i++) {
      mouse.frame(view());
      send();
      show.ticks(1);
      refresh();
    }
  }

 private:
  engine::test::SceneFile file_;
  std::shared_ptr<const engine::Snapshot> now_;
  std::shared_ptr<const engine::ValueSnapshot> values_;

 public:
  engine::test::Show show;
  ViewportMouse mouse;
  double clock = 1;
};

TEST(ViewportMouse, ClickSelectsAndDoubleClickFollows) {
  MouseRig fixture;
  fixture.move(200, 200);
  fixture.button(true);
  fixture.button(false);
  EXPECT_EQ(fixture.mouse.consume_selection(), kBallPath);
  EXPECT_FALSE(fixture.mouse.followed().has_value());
  fixture.clock += 0.2;
  fixture.button(true);
  fixture.button(false);
  EXPECT_TRUE(fixture.mouse.followed().has_value());
  fixture.mouse.stop_following();
  fixture.clock += 5;
  fixture.button(true);
  fixture.button(false);
  EXPECT_FALSE(fixture.mouse.followed().has_value()) << "too late for a double click";
  EXPECT_TRUE(fixture.mouse.consume_messages().empty());
}

TEST(ViewportMouse, DragPullsThePartToTheMouse) {
  MouseRig fixture;
  fixture.move(200, 200);
  fixture.button(true);
  EXPECT_TRUE(fixture.mouse.has_grab());
  fixture.move(280, 120);
  ASSERT_TRUE(fixture.mouse.spring_marker(fixture.view()).has_value());
  EXPECT_EQ(fixture.mouse.spring_marker(fixture.view())->name, "my body  ball");
  fixture.play(120);
  // fovy is 40° and the surface 9.5 m away: 200 pixels are 9.5·tan 20°; the ball turns about the grabbed point
  const double meters = 9.5 * std::tan(20 * kPi / 180) * 80 / 200;
  const double x = fixture.show.read(kBallPath + "/center", 0);
  const double z = fixture.show.read(kBallPath + "/center", 2);
  EXPECT_NEAR(std::hypot(x - meters, z - 1 - meters), 0, 0.55) << "within the ball's radius of the mouse";
  EXPECT_GT(x, 0.7 * meters);
  EXPECT_GT(z - 1, 0.7 * meters);
  fixture.button(false);
  EXPECT_FALSE(fixture.mouse.has_grab());
  fixture.show.ticks(1);
  EXPECT_EQ(fixture.show.link.counters.refused.load(), 0u);
  EXPECT_TRUE(fixture.mouse.consume_selection().empty()) << "a drag is no click";
}

TEST(ViewportMouse, CtrlPushesAwayFromTheEye) {
  MouseRig fixture;
  fixture.move(200, 200);
  fixture.button(true, panel::KeyMods{true, false, false});
  fixture.button(false);
  fixture.show.ticks(1);
  EXPECT_NEAR(fixture.show.read(kBallPath + "/linear_velocity", 1), ViewportMouse::kPushSpeed, 0.02);
  EXPECT_FALSE(fixture.mouse.has_grab());
}

TEST(ViewportMouse, LeavesOtherInputToTheCamera) {
  MouseRig fixture;
  fixture.move(20, 20);
  fixture.button(true);
  EXPECT_FALSE(fixture.mouse.has_grab());
  fixture.button(false);
  fixture.move(200, 200);
  fixture.button(true, panel::KeyMods{false, true, false});
  EXPECT_FALSE(fixture.mouse.has_grab()) << "Shift pans the camera";
  EXPECT_TRUE(fixture.mouse.consume_messages().empty());
}

}  // namespace
}  // namespace limber::app::test
