// Debug overlay: positions of its lines, and that they are visible in the image.
#include "ui/render/overlay_lines.h"

#include "render/stage.h"

namespace limber::render::test {
namespace {

using Kind = sim::OverlayMark::Kind;

sim::OverlayMark mark(Kind kind, const Vec3& at, const Vec3& vector = {0, 0, 0}) {
  sim::OverlayMark made;
  made.kind = kind;
  made.size = 0.5;
  made.position = at;
  made.vector = vector;
  return made;
}

Vec3 from(const OverlayLine& line) { return {line.from[0], line.from[1], line.from[2]}; }
Vec3 to(const OverlayLine& line) { return {line.to[0], line.to[1], line.to[2]}; }

TEST(OverlayLines, ArrowLengthIsProportionalToForce) {
  engine::Snapshot now;
  now.overlay = {mark(Kind::force, {1, 2, 3}, {0, 0, 2}), mark(Kind::force, {0, 0, 0}, {100, 0, 0}),
                 mark(Kind::force, {0, 0, 0}, {0.001, 0, 0})};
  OverlayLines lines;
  lines.update(now, now, 1, 1);
  ASSERT_EQ(lines.lines().size(), 10U) << "a shaft and four barbs each, and none for tiny forces";
  EXPECT_EQ(from(lines.lines()[0]), Vec3(1, 2, 3));
  EXPECT_EQ(to(lines.lines()[0]), Vec3(1, 2, 4)) << "half a meter for one weight";
  EXPECT_EQ(to(lines.lines()[5]), Vec3(2, 0, 0)) << "no longer than four weights";
}

TEST(OverlayLines, InterpolateBetweenTicks) {
  engine::Snapshot before;
  engine::Snapshot now;
  before.overlay = {mark(Kind::force, {0, 0, 0}, {0, 0, 2}), mark(Kind::contact, {0, 0, 0}, {0, 0, 2})};
  now.overlay = {mark(Kind::force, {4, 0, 0}, {0, 0, 4}), mark(Kind::contact, {4, 0, 0}, {0, 0, 4})};
  OverlayLines lines;
  lines.update(before, now, 0.25, 1);
  EXPECT_EQ(from(lines.lines()[0]), Vec3(1, 0, 0));
  EXPECT_EQ(to(lines.lines()[0]), Vec3(1, 0, 1.25));
  EXPECT_NEAR(lines.lines().back().to[0], 4, 1) << "contacts are not interpolated";
  now.overlay[0].slot = 9;
  lines.update(before, now, 0.25, 1);
  EXPECT_EQ(from(lines.lines()[0]), Vec3(4, 0, 0)) << "marks of different parts are not interpolated";
}

TEST(OverlayLines, HingesShowAnArcOrACircle) {
  engine::Snapshot now;
  now.overlay = {mark(Kind::rotation_axis, {0, 0, 0})};
  now.overlay[0].axis = 2;
  now.overlay[0].limited = true;
  now.overlay[0].lower = 0;
  now.overlay[0].upper = kPi / 2;
  now.overlay[0].value = kPi / 2;
  OverlayLines lines;
  lines.update(now, now, 1, 1);
  for (const OverlayLine& line : lines.lines()) {
    if (line.from[2] != 0) continue;  // the axis
    EXPECT_GT(line.to[0], -1e-6) << "from x towards y";
    EXPECT_GT(line.to[1], -1e-6);
  }
  EXPECT_NEAR(lines.lines().back().to[1], 0.4, 1e-6) << "the spoke shows the joint angle";
  now.overlay[0].limited = false;
  lines.update(now, now, 1, 1);
  EXPECT_EQ(lines.lines().size(), 1U + 32 + 1);
}

bool is_red_line(const Vec3& c) { return c.x > 120 && c.x > 2.5 * c.y && c.x > 2.5 * c.z; }

TEST(OverlayLines, AreVisibleWhileEnabled) {
  TestScene scene;
  sim::Shape& ball = **scene.world.shapes().add("ball", round(model::ShapeKind::sphere, 0.3));
  scene.set("/visuals/shape/ball/diffuse_color", {0, 0, 0.1});
  sim::Body& body = **scene.world.add_body("ball");
  sim::Part& part = **body.add_part("part", ball, 1, {{0, 0, 1}, quat_identity()});
  scene.set("/physics/sim/gravity", {0, 0, 0});
  scene.look_from({0, -4, 1}, {0, 0, 1});
  const auto red_at = [&](Quality quality, bool on) {
    scene.set("/visuals/look/overlay", {on ? 1.0 : 0.0});
    part.set_pose({{0, 0, 1}, quat_identity()});
    part.set_velocity(Vec3(0), Vec3(0));
    part.apply_force({3 * 9.81, 0, 0});
    scene.world.step();
    const auto now = scene.snapshot();
    const Pixels image = draw(*now, 320, 180, quality);
    // outside of the ball, on the arrow
    const Spot spot = spot_of(*now, part.center() + Vec3(0.6, 0, 0), 320, 180);
    int red = 0;
    for (int y = spot.y - 3; y <= spot.y + 3; y++) red += is_red_line(color(image, spot.x, y)) ? 1 : 0;
    return red;
  };
  for (const Quality quality : {Quality::low, Quality::high}) {
    EXPECT_EQ(red_at(quality, false), 0);
    EXPECT_GE(red_at(quality, true), 1);
    EXPECT_LE(red_at(quality, true), 4) << "a line, no more";
  }
  EXPECT_TRUE(renderer(Quality::low).shader_error().empty());
}

TEST(OverlayLines, ClipsLinesBehindTheEye) {
  TestScene scene;
  scene.set("/visuals/look/floor", {0});
  scene.look_from({0, -4, 1}, {0, 0, 1});
  engine::Snapshot now = *scene.snapshot();
  const Pixels without = draw(now, 64, 36);
  now.overlay = {mark(Kind::force, {0, -9, 1}, {0.5, 0.5, 0.5}), mark(Kind::center, {3, -9, 2})};
  EXPECT_EQ(draw(now, 64, 36).bytes, without.bytes);
}

}  // namespace
}  // namespace limber::render::test
