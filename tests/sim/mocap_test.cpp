// Motion capture: joints follow their samples within limits, whatever arrives; losses are held and reported.
#include <random>

#include "base/memory/archive.h"
#include "sim/counted_new.h"
#include "sim/mocap_rig.h"

namespace limber::sim {
namespace {

using namespace test;

void expect_place(const Vec3& a, const Vec3& b, double tolerance = 1e-9) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

TEST(Mocap, AJointAppearsWhereItsFirstSampleIs) {
  MocapFixture s;
  const MocapSource& source = s.add_places();
  EXPECT_EQ(s.send("/p", {1, 2, 3, 4, 5, 6}), "");
  s.ticks(1);
  ASSERT_EQ(source.joints().size(), 2u);
  EXPECT_EQ(source.joints()[1]->name(), "joint_2");
  expect_place(s.vec(s.joint(source, 1).id(), "position"), {4, 5, 6});
  EXPECT_EQ(s.number(s.joint(source).id(), "speed"), 0) << "an appearance is no motion";
  EXPECT_EQ(s.number(s.joint(source).id(), "confidence"), 1);
  EXPECT_NEAR(s.number(s.joint(source).id(), "age"), s.dt(), 1e-12);
  EXPECT_EQ(s.number(source.id(), "frames"), 1);
}

// place on stage = offset + Rx·Ry·Rz·(scale·p)
TEST(Mocap, OffsetRotationAndScaleMapItToTheStage) {
  MocapFixture s;
  const MocapSource& source = s.add_places();
  s.set(source.id(), "offset", {10, 20, 30});
  s.set(source.id(), "rotation", {0, 0, 90});
  s.set(source.id(), "scale", {2});
  s.send("/p", {1, 2, 3});
  s.ticks(1);
  expect_place(s.joint(source).pose().position, {10 - 4, 20 + 2, 30 + 6});
}

TEST(Mocap, ASlowSourceMovesEvenly) {
  MocapFixture s;
  const MocapSource& source = s.add_places();
  // 15 frames per second at 60 ticks per second, 1 m/s
  std::vector<double> speeds;
  for (int tick = 0; tick < 120; tick++) {
    if (tick % 4 == 0) s.send("/p", {tick * s.dt(), 0, 0});
    s.ticks(1);
    if (tick > 60) speeds.push_back(s.joint(source).velocity().x);
  }
  for (const double speed : speeds) EXPECT_NEAR(speed, 1, 1e-6);
}

// Loss, bursts, duplicates, reordering and jumps of a random walk.
TEST(Mocap, NoJointIsFasterThanItsLimit) {
  MocapFixture s;
  const MocapSource& source = s.add(setup_of({{"/p", "x y z qw qx qy qz"}}));
  s.set(source.id(), "max_speed", {3});
  s.set(source.id(), "max_turn", {2});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  std::vector<std::array<double, 7>> late;
  for (int tick = 0; tick < 5000; tick++) {
    const Pose before = source.joints().empty() ? Pose{} : s.joint(source).pose();
    const bool placed = !source.joints().empty() && s.joint(source).placed();
    const int count = draw(random) > 0.9 ? 20 : draw(random) > 0 ? 1 : 0;
    for (int i = 0; i < count; i++) {
      std::array<double, 7> frame{};
      for (double& value : frame) value = draw(random);
      if (draw(random) > 0.8) frame[0] *= 1e5;
      if (draw(random) > 0.7) late.push_back(frame);
      if (!late.empty() && draw(random) > 0.5) std::swap(frame, late[late.size() / 2]);
      s.send("/p", {frame[0], frame[1], frame[2], frame[3], frame[4], frame[5], frame[6]});
    }
    s.ticks(1);
    if (!placed) continue;
    const Pose now = s.joint(source).pose();
    ASSERT_LE(glm::length(now.position - before.position), 3 * s.dt() * (1 + 1e-9));
    const double cosine = std::min(std::abs(glm::dot(now.rotation, before.rotation)), 1.0);
    ASSERT_LE(2 * std::acos(cosine), 2 * s.dt() + 1e-6);
    ASSERT_TRUE(is_finite(now.position) && is_finite(now.rotation));
  }
}

TEST(Mocap, ALostSourceIsHeldThenFadesAndIsReportedOnce) {
  MocapFixture s;
  const MocapSource& source = s.add_places();
  s.set(source.id(), "timeout", {0.5});
  s.set(source.id(), "fade", {2});
  const std::uint64_t log_before = log_newest();
  s.send("/p", {1, 2, 3});
  s.ticks(30);
  EXPECT_EQ(s.number(source.id(), "tracked"), 1);
  EXPECT_EQ(s.number(s.joint(source).id(), "confidence"), 1);
  s.ticks(60);  // 1.5 s after the frame: half of the fade
  EXPECT_EQ(s.number(source.id(), "tracked"), 0);
  EXPECT_EQ(s.number(source.id(), "missing"), 1);
  EXPECT_NEAR(s.number(s.joint(source).id(), "confidence"), 0.5, 1e-9);
  expect_place(s.joint(source).pose().position, {1, 2, 3});
  s.ticks(600);
  EXPECT_EQ(s.number(s.joint(source).id(), "confidence"), 0);
  EXPECT_EQ(log_newest() - log_before, 1u);
  s.send("/p", {1, 2, 3});
  s.ticks(1);
  EXPECT_EQ(s.number(source.id(), "tracked"), 1);
  EXPECT_EQ(log_newest() - log_before, 2u) << "it is back";
}

TEST(Mocap, ExpectedJointsThatDoNotArriveAreReported) {
  MocapFixture s;
  MocapSource& source = s.add(setup_of({{"/p", "joint x y z"}}, {"hand", "foot"}));
  const std::uint64_t before = log_newest();
  for (int i = 0; i < 150; i++) {
    s.send("/p", {0, 0, 1}, "hand");
    s.ticks(1);
  }
  EXPECT_EQ(log_newest() - before, 1u);
  EXPECT_EQ(s.number(source.find("foot")->id(), "age"), -1);
  EXPECT_EQ(s.number(source.find("foot")->id(), "confidence"), 0);
}

TEST(Mocap, LocalPosesAddUpAlongTheBones) {
  MocapFixture s;
  MocapSource& source = s.add(setup_of({{"/b", "joint lx ly lz lqw lqx lqy lqz"}}, {},
                                       {{"hips", "spine"}, {"spine", "chest"}, {"chest", "head"}}));
  // the head arrives first, and there is no spine: the chest is attached to the hips
  s.send("/b", {0, 0, 0.5, 1, 0, 0, 0}, "head");
  const double half = std::sqrt(0.5);
  s.send("/b", {1, 0, 0, half, 0, 0, half}, "hips");      // a quarter turn about z
  s.send("/b", {0.25, 0, 0, half, half, 0, 0}, "chest");  // a quarter turn about x
  s.ticks(1);
  expect_place(source.find("chest")->pose().position, {1, 0.25, 0});
  // Rz(90°)·Rx(90°)·(0, 0, 0.5) = Rz(90°)·(0, −0.5, 0) = (0.5, 0, 0)
  expect_place(source.find("head")->pose().position, {1.5, 0.25, 0});
  const std::vector<double> local = s.get(source.find("chest")->id(), "local_rotation");
  EXPECT_NEAR(std::abs(local[0] * half + local[3] * half), 1, 1e-12) << "relative to the hips";
}

TEST(Mocap, AVmcDancerStandsUpright) {
  MocapFixture s;
  MocapSetup setup;
  setup.axes = {MocapAxes::Up::y, true, 1};
  ASSERT_TRUE(set_mocap_dialect(setup, "vmc", "", true).ok());
  MocapSource& source = s.add(std::move(setup));
  EXPECT_EQ(s.send("/VMC/Ext/Root/Pos", {0, 0, 0, 0, 0, 0, 1}, "root"), "");
  EXPECT_EQ(s.send("/VMC/Ext/Bone/Pos", {0, 1, 0, 0, 0, 0, 1}, "Hips"), "");
  EXPECT_EQ(s.send("/VMC/Ext/Bone/Pos", {0, 0.5, 0, 0, 0, 0, 1}, "Spine"), "");
  EXPECT_EQ(s.send("/VMC/Ext/Bone/Pos", {0.25, 0.1, 0.5, 0, 0, 0, 1}, "LeftUpperArm"), "");
  EXPECT_EQ(s.send("/VMC/Ext/Blend/Val", {1}, "Joy"), "") << "other messages of the protocol are ignored";
  EXPECT_EQ(s.send("/VMC/Other", {1}), "not received");
  s.ticks(1);
  expect_place(source.find("Spine")->pose().position, {0, 0, 1.5});
  // forward (z) becomes y; left and right remain
  expect_place(source.find("LeftUpperArm")->pose().position, {0.25, 0.5, 1.6});
}

TEST(Mocap, SwappedDancersAreReported) {
  MocapFixture s;
  s.add(setup_of({{"/a", "x y z"}}), "a");
  s.add(setup_of({{"/b", "x y z"}}), "b");
  const auto place = [&](const char* address, double x) { s.send(address, {x, 0, 1, x, 0, 2}); };
  place("/a", 0);
  place("/b", 3);
  s.ticks(5);
  const std::uint64_t before = log_newest();
  place("/a", 0.1);  // a step
  s.ticks(5);
  EXPECT_EQ(log_newest(), before);
  place("/a", 3);
  s.ticks(2);  // the other one's frame comes later
  place("/b", 0.1);
  s.ticks(5);
  EXPECT_EQ(log_newest(), before + 1);
  place("/b", 1.5);  // a jump to another place is no swap
  s.ticks(5);
  EXPECT_EQ(log_newest(), before + 1);
}

TEST(Mocap, SourcesWithTheSameNameOrAddressAreRejected) {
  MocapFixture s;
  s.add_places();
  const auto setup = std::make_shared<const MocapSetup>(setup_of({{"/p", "x y z"}}));
  EXPECT_EQ(s.list().add("dancer", setup).error(), "there is a mocap source 'dancer' already; names are unique");
  EXPECT_EQ(s.list().add("other", setup).error(),
            "mocap 'other': mocap 'dancer' receives /p already; give each source a dancer or messages of its own");
  const auto loop = std::make_shared<const MocapSetup>(setup_of({}, {}, {{"a", "b"}, {"b", "c"}, {"c", "a"}}));
  EXPECT_EQ(s.list().add("other", loop).error(),
            "mocap 'other': bones: 'b' is its own ancestor; remove one of the bones");
}

TEST(Mocap, FramesThatDoNotFitAreRejectedAndChangeNothing) {
  MocapFixture s;
  const MocapSource& source = s.add_places();
  s.send("/p", {1, 2, 3});
  EXPECT_EQ(s.send("/p", {1, 2}), "mocap 'dancer': takes a multiple of 3 arguments, got 2");
  s.ticks(1);
  EXPECT_EQ(s.number(source.id(), "frames"), 1);
  EXPECT_EQ(s.send("/q", {1, 2, 3}), "not received");
  Message flood{"/p", std::vector<Arg>(3 * 257, Arg::of(1.0))};
  EXPECT_EQ(s.list().accept(flood)->error(), "mocap 'dancer': has 257 joints; at most 256 are accepted");
  EXPECT_EQ(source.joints().size(), 1u);
}

// A joint that a scene expects doesn't take the place of a joint of messages without names.
TEST(Mocap, NumbersOfMessagesWithoutNamesSkipExpectedJoints) {
  MocapFixture s;
  MocapSource& source = s.add_places();
  ASSERT_TRUE(source.expect("hat").ok());
  ASSERT_TRUE(source.expect("joint_2").ok());
  EXPECT_EQ(s.send("/p", {1, 0, 0, 2, 0, 0, 3, 0, 0}), "");
  s.ticks(1);
  EXPECT_EQ(source.joints().size(), 4u);
  EXPECT_FALSE(source.find("hat")->seen());
  for (const auto& [name, x] : {std::pair("joint_1", 1), {"joint_2", 2}, {"joint_3", 3}}) {
    ASSERT_NE(source.find(name), nullptr) << name;
    expect_place(source.find(name)->pose().position, {static_cast<double>(x), 0, 0});
  }
}

TEST(Mocap, AnInactiveSourceHasNoVelocity) {
  MocapFixture s;
  const MocapSource& source = s.add_places();
  for (int i = 0; i < 10; i++) {
    s.send("/p", {i * s.dt(), 0, 0});
    s.ticks(1);
  }
  EXPECT_NEAR(s.number(source.id(), "mean_speed"), 1, 1e-6);
  const Vec3 place = s.joint(source).pose().position;
  s.set(source.id(), "active", {0});
  s.send("/p", {5, 0, 0});
  s.ticks(1);
  expect_place(s.joint(source).pose().position, place);
  EXPECT_EQ(s.number(source.id(), "mean_speed"), 0);
}

TEST(Mocap, APlayerFollowsItsFile) {
  MocapFixture s;
  const MocapSource& source = s.play(
      "HIERARCHY ROOT hips\n{ OFFSET 0 0 0 CHANNELS 3 Xposition Yposition Zposition JOINT head\n{ OFFSET 0 0.5 0 "
      "CHANNELS 0 } } MOTION Frames: 3 Frame Time: 1  0 1 0  1 1 0  3 1 0");
  s.ticks(30);  // half a second
  expect_place(s.joint(source).pose().position, {0.5, 0, 1}, 1e-6);
  expect_place(s.joint(source, 1).pose().position, {0.5, 0, 1.5}, 1e-6);
  EXPECT_NEAR(s.joint(source).velocity().x, 1, 1e-5);
  s.set(source.id(), "speed", {0.5});
  s.ticks(60);
  EXPECT_NEAR(s.number(source.id(), "time"), 1, 1e-9);
  s.set(source.id(), "playing", {0});
  s.set(source.id(), "time", {1.5});
  s.ticks(60);
  expect_place(s.joint(source).pose().position, {2, 0, 1}, 1e-6);
  s.set(source.id(), "playing", {1});
  s.set(source.id(), "loop", {0});
  s.set(source.id(), "speed", {100});
  s.ticks(60);
  EXPECT_EQ(s.number(source.id(), "time"), 2) << "the end";
  EXPECT_EQ(s.number(source.id(), "duration"), 2);
  s.set(source.id(), "loop", {1});
  s.set(source.id(), "speed", {-1});
  s.ticks(150);  // from 2 s back to 1.5 s, past the beginning
  EXPECT_NEAR(s.number(source.id(), "time"), 1.5, 1e-9);
}

// Two joints move apart symmetrically along y; their distance from the center is the expansion.
TEST(Mocap, FeaturesAreThoseOfTheirFormulas) {
  MocapFixture s;
  MocapSource& source = s.add(setup_of({{"/p", "joint x y z"}}));
  const auto place = [&](double half, double lift) {
    s.send("/p", {0, half, 1}, "left_hand");
    s.send("/p", {0, -half, 1 + lift}, "right_hand");
    s.ticks(1);
  };
  for (int i = 0; i < 20; i++) place(1 + i * s.dt(), 0);  // 1 m/s each
  expect_place(s.vec(source.id(), "center"), {0, 0, 1}, 1e-9);
  EXPECT_NEAR(s.number(source.id(), "expansion"), 1 + 19 * s.dt(), 1e-9);
  EXPECT_NEAR(s.number(source.id(), "mean_speed"), 1, 1e-9);
  EXPECT_NEAR(s.number(source.id(), "symmetry"), 1, 1e-9);
  for (int i = 0; i < 180; i++) place(1, 0.5);
  EXPECT_NEAR(s.number(source.id(), "jerk"), 0, 0.1) << "at rest";
  EXPECT_EQ(s.number(source.id(), "contacts"), 0);
  s.set(source.id(), "floor", {0.95});
  s.ticks(1);
  EXPECT_EQ(s.number(source.id(), "contacts"), 1) << "the left hand, 5 cm above the floor";
  EXPECT_EQ(s.number(source.find("left_hand")->id(), "contact"), 1);
  // mirrored in the plane through the center, whose normal is that from right to left
  const Vec3 left(0, 1, -0.25);
  const Vec3 normal = normalized(Vec3(0, 2, -0.5));
  const Vec3 mirrored = left - 2 * glm::dot(left, normal) * normal;
  const double error = glm::length(mirrored - Vec3(0, -1, 0.25));
  EXPECT_NEAR(s.number(source.id(), "symmetry"), 1 - error / (2 * glm::length(left)), 1e-9);
}

// x = sin(ω·t) has the jerk ω³·cos(ω·t), whose mean magnitude over a period is 2/π·ω³.
TEST(Mocap, JerkIsThatOfAnOscillation) {
  MocapFixture s;
  s.set(s.world.id(), "timestep", {0.002});
  const MocapSource& source = s.add_places();
  s.set(source.id(), "max_speed", {1000});
  const double omega = 30;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 1100; i++) {
    s.send("/p", {std::sin(omega * i * 0.002), 0, 0});
    s.ticks(1);
    if (i * 0.002 * omega < 2 * kPi * 5) continue;
    sum += s.number(source.id(), "jerk");
    count++;
  }
  const double mean = 2 / kPi * omega * omega * omega;
  EXPECT_NEAR(sum / count, mean, 0.05 * mean);
}

TEST(Mocap, ACheckpointRestoresItsMotion) {
  MocapFixture s;
  MocapSource& source = s.add_places();
  s.set(source.id(), "max_speed", {2});
  s.send("/p", {0, 0, 0});
  s.ticks(2);
  s.send("/p", {5, 0, 0});
  s.ticks(3);
  Archive archive;
  archive.begin_saving();
  s.list().serialize(archive);
  const double time = s.world.time();
  s.ticks(20);
  const Vec3 later = s.joint(source).pose().position;
  archive.begin_loading();
  s.list().serialize(archive);
  s.world.restart_time(s.world.tick() - 20, time);
  s.ticks(20);
  EXPECT_EQ(s.joint(source).pose().position, later);
}

TEST(Mocap, ThreeDancersAllocateNothing) {
  MocapFixture s;
  std::vector<Message> frames;
  for (int i = 0; i < 3; i++) {
    MocapSetup setup;
    ASSERT_TRUE(set_mocap_dialect(setup, "osc", std::to_string(i), true).ok());
    s.add(std::move(setup), "dancer" + std::to_string(i));
    const std::string prefix = "/mocap/" + std::to_string(i) + "/joint/";
    frames.push_back({prefix + "pos_world", std::vector<Arg>(67 * 3, Arg::of(0.5))});
    frames.push_back({prefix + "rot_world", std::vector<Arg>(67 * 4, Arg::of(0.5))});
  }
  const auto frame = [&] {
    for (const Message& message : frames) EXPECT_TRUE(s.list().accept(message)->ok());
  };
  for (int i = 0; i < 5; i++) {
    frame();
    s.ticks(1);
  }
  const std::size_t before = allocations();
  for (int i = 0; i < 20; i++) {
    frame();
    frame();  // 120 per second
    s.list().step(s.dt());
  }
  EXPECT_EQ(allocations(), before);
}

TEST(Mocap, ChangesTheHashOnlyIfItIsUsed) {
  MocapFixture a;
  MocapFixture b;
  a.ticks(3);
  b.ticks(3);
  EXPECT_EQ(a.world.state_hash(), b.world.state_hash());
  MocapSource& source = b.add_places();
  b.send("/p", {1, 2, 3});
  b.ticks(1);
  a.ticks(1);
  const std::uint64_t before = b.world.state_hash();
  EXPECT_NE(a.world.state_hash(), before);
  b.send("/p", {1, 2, 3.5});
  b.ticks(1);
  EXPECT_NE(b.world.state_hash(), before);
  b.list().remove(source);
  b.world.restart_time(4, a.world.time());
  EXPECT_EQ(a.world.state_hash(), b.world.state_hash());
}

}  // namespace
}  // namespace limber::sim
