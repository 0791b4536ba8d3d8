// A mouse in the picture, without a window: what it says to a world, and what that does.
#include "app/picture_hand.h"

#include "engine/show.h"

namespace limber::app_test {
namespace {

constexpr const char* kBallToHold = R"(
sim.gravity = vec3(0, 0, 0)
visuals.camera.eye = vec3(0, -10, 1)
visuals.camera.target = vec3(0, 0, 1)
visuals.camera.eye = vec3(0, -10, 1)
local body = sim:add_body("my body")
body:add_part("ball", sim:add_sphere_shape("ball", 0.5), { position = vec3(0, 0, 1), mass = 3 })
)";
const std::string kBallPath = "/physics/body/my%20body/part/ball";

class HandRig {
 public:
  HandRig() : file_(kBallToHold), show(file_.path()) { look(); }

  void look() {
    const std::uint64_t ask = show.link.ask_image();
    do {
      show.engine.idle();
      image_ = show.link.images.read();
    } while (image_ == nullptr || image_->asks < ask);
    now_ = show.link.snapshots.read();
  }
  HandView view() const { return {*now_, *image_, lens_of(camera_of(*now_), 400, 400), 400, 400, clock}; }
  void move(double x, double y) {
    InputEvent event;
    event.x = x;
    event.y = y;
    hand.event(event, view());
  }
  void button(bool down, KeyMods mods = {}) {
    InputEvent event;
    event.kind = InputEvent::Kind::button;
    event.down = down;
    event.mods = mods;
    hand.event(event, view());
    send();
  }
  void send() {
    for (Message& message : hand.take_messages()) show.link.inbox.push({{std::move(message)}, {Hand::panel, 0, 0}});
  }
  void play(int ticks) {
    for (int i = 0; i < ticks; i++) {
      hand.frame(view());
      send();
      show.ticks(1);
      look();
    }
  }

 private:
  engine_test::SceneFile file_;
  std::shared_ptr<const Snapshot> now_;
  std::shared_ptr<const Image> image_;

 public:
  engine_test::Show show;
  PictureHand hand;
  double clock = 1;
};

TEST(PictureHand, AClickChoosesAndTwoFollow) {
  HandRig rig;
  rig.move(200, 200);
  rig.button(true);
  rig.button(false);
  EXPECT_EQ(rig.hand.take_chosen(), kBallPath);
  EXPECT_FALSE(rig.hand.followed().has_value());
  rig.clock += 0.2;
  rig.button(true);
  rig.button(false);
  EXPECT_TRUE(rig.hand.followed().has_value());
  rig.hand.follow_nothing();
  rig.clock += 5;
  rig.button(true);
  rig.button(false);
  EXPECT_FALSE(rig.hand.followed().has_value()) << "too late for a double click";
  EXPECT_TRUE(rig.hand.take_messages().empty());
}

TEST(PictureHand, ADragPullsThePartToTheHand) {
  HandRig rig;
  rig.move(200, 200);
  rig.button(true);
  EXPECT_TRUE(rig.hand.holds());
  rig.move(280, 120);
  ASSERT_TRUE(rig.hand.mark(rig.view()).has_value());
  EXPECT_EQ(rig.hand.mark(rig.view())->name, "my body  ball");
  rig.play(120);
  // fovy 40 at the surface, 9.5 m away: 200 pixels are 9.5·tan 20°; the ball turns about the point that is held
  const double metres = 9.5 * std::tan(20 * kPi / 180) * 80 / 200;
  const double x = rig.show.read(kBallPath + "/center", 0);
  const double z = rig.show.read(kBallPath + "/center", 2);
  EXPECT_NEAR(std::hypot(x - metres, z - 1 - metres), 0, 0.55) << "within the ball's radius of the hand";
  EXPECT_GT(x, 0.7 * metres);
  EXPECT_GT(z - 1, 0.7 * metres);
  rig.button(false);
  EXPECT_FALSE(rig.hand.holds());
  rig.show.ticks(1);
  EXPECT_EQ(rig.show.link.counters.refused.load(), 0u);
  EXPECT_TRUE(rig.hand.take_chosen().empty()) << "a drag is no click";
}

TEST(PictureHand, CtrlPushesAwayFromTheEye) {
  HandRig rig;
  rig.move(200, 200);
  rig.button(true, KeyMods{true, false, false});
  rig.button(false);
  rig.show.ticks(1);
  EXPECT_NEAR(rig.show.read(kBallPath + "/linear_velocity", 1), PictureHand::kPushSpeed, 0.02);
  EXPECT_FALSE(rig.hand.holds());
}

TEST(PictureHand, WhatIsNoPartIsTheViews) {
  HandRig rig;
  rig.move(20, 20);
  rig.button(true);
  EXPECT_FALSE(rig.hand.holds());
  rig.button(false);
  rig.move(200, 200);
  rig.button(true, KeyMods{false, true, false});
  EXPECT_FALSE(rig.hand.holds()) << "Shift shifts the view";
  EXPECT_TRUE(rig.hand.take_messages().empty());
}

}  // namespace
}  // namespace limber::app_test
