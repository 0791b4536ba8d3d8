// Snapshots: what they hold, and that the roster is made anew only when somebody comes or goes.
#include "engine/publish.h"

#include "engine/show.h"

namespace limber::engine_test {
namespace {

void expect_numbers(const Snapshot& snapshot, std::uint32_t at, const std::vector<double>& values,
                    const std::string& what) {
  for (std::size_t i = 0; i < values.size(); i++)
    EXPECT_EQ(snapshot.live.at(at + i), values[i]) << what << " [" << i << "]";
}

TEST(Publisher, ASnapshotHoldsWhatTheStoreTells) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  EXPECT_EQ(latest.read(), nullptr);
  for (int i = 0; i < 3; i++) rig.world.step();
  publisher.publish(true, 0.75);
  const auto snapshot = latest.read();
  ASSERT_NE(snapshot, nullptr);
  EXPECT_EQ(snapshot->tick, 3U);
  EXPECT_DOUBLE_EQ(snapshot->time, 3.0 / 60);
  EXPECT_EQ(snapshot->speed, 0.75);
  EXPECT_TRUE(snapshot->paused);
  const LiveOffsets& at = live_offsets();
  ASSERT_EQ(snapshot->roster->bodies.size(), 3U);
  const char* const names[] = {"arm", "1", "floor"};
  for (std::size_t b = 0; b < 3; b++) {
    const RosterBody& body = snapshot->roster->bodies[b];
    const Body& real = *rig.world.bodies()[b];
    EXPECT_EQ(body.name, names[b]);
    EXPECT_EQ(snapshot->live.at(body.enabled_at), 1);
    ASSERT_EQ(body.joints.size(), real.joints().size());
    ASSERT_EQ(body.joint_names.size(), real.joints().size());
    ASSERT_EQ(body.parts.size(), real.parts().size());
    for (std::size_t j = 0; j < body.joints.size(); j++) {
      const std::string path = rig.store.path(real.joints()[j]->id());
      EXPECT_EQ(body.joint_names[j], real.joints()[j]->name());
      expect_numbers(*snapshot, body.joints[j] + at.joint_position, rig.read(path + "/position"), path);
      expect_numbers(*snapshot, body.joints[j] + at.joint_rotation, rig.read(path + "/rotation"), path);
      expect_numbers(*snapshot, body.joints[j] + at.joint_relrot, rig.read(path + "/relrot"), path);
      expect_numbers(*snapshot, body.joints[j] + at.joint_offsets, rig.read(path + "/offsets"), path);
    }
    for (std::size_t p = 0; p < body.parts.size(); p++) {
      const std::string path = rig.store.path(real.parts()[p]->id());
      expect_numbers(*snapshot, body.parts[p] + at.part_position, rig.read(path + "/position"), path);
      expect_numbers(*snapshot, body.parts[p] + at.part_rotation, rig.read(path + "/rotation"), path);
    }
  }
}

TEST(Publisher, TheRosterIsSharedUntilSomebodyComesOrGoes) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  const auto roster_now = [&] {
    rig.world.step();
    publisher.publish(false, 1);
    return latest.read()->roster;
  };
  const auto first = roster_now();
  rig.send("/physics/part/mass", 2);
  EXPECT_EQ(roster_now(), first) << "values change no roster";
  ASSERT_TRUE(rig.world.add_body("new").ok());
  const auto second = roster_now();
  EXPECT_NE(second, first);
  ASSERT_EQ(second->bodies.size(), 4U);
  EXPECT_EQ(second->bodies[3].name, "new");
  rig.world.remove_body(*rig.world.find_body("arm"));
  const auto third = roster_now();
  ASSERT_EQ(third->bodies.size(), 3U);
  EXPECT_EQ(third->bodies[0].name, "1");
  EXPECT_EQ(first->bodies.size(), 3U) << "who holds an old one still has it";
}

TEST(Publisher, AHeldSnapshotIsNotWrittenAgain) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  publisher.publish(false, 1);
  const auto held = latest.read();
  const std::vector<double> live = held->live;
  for (int i = 0; i < 10; i++) {
    rig.world.step();
    publisher.publish(false, 1);
  }
  EXPECT_EQ(held->tick, 0U);
  EXPECT_EQ(held->live, live);
  EXPECT_EQ(latest.read()->tick, 10U);
}

TEST(Publisher, TheDebugPictureIsTakenWhileItIsOn) {
  const SceneFile scene(R"(
sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 1 })
)");
  Show show(scene.path());
  const auto marks = [&] {
    show.ticks(1);
    return show.link.snapshots.read()->overlay.size();
  };
  EXPECT_EQ(marks(), 0U);
  show.send("/visuals/look/overlay", 1);
  EXPECT_GT(marks(), 0U);
  show.send("/transport/reset");
  EXPECT_GT(marks(), 0U) << "it belongs to who looks, not to the scene";
  show.send("/visuals/look/overlay", 0);
  EXPECT_EQ(marks(), 0U);
}

TEST(Publisher, ASwitchedOffBodyIsMarked) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  rig.send("/physics/body/1/enabled", false);
  rig.world.step();
  publisher.publish(false, 1);
  const auto snapshot = latest.read();
  EXPECT_EQ(snapshot->live.at(snapshot->roster->bodies[0].enabled_at), 1);
  EXPECT_EQ(snapshot->live.at(snapshot->roster->bodies[1].enabled_at), 0);
}

}  // namespace
}  // namespace limber::engine_test
