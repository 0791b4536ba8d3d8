// Snapshots: their contents, and a list of bodies that is rebuilt only when bodies are added or removed.
#include "engine/output/publisher.h"

#include "engine/show.h"

namespace limber::engine::test {
namespace {

void expect_numbers(const Snapshot& snapshot, std::uint32_t at, const std::vector<double>& values,
                    const std::string& label) {
  for (std::size_t i = 0; i < values.size(); i++)
    EXPECT_EQ(snapshot.transient.at(at + i), values[i]) << label << " [" << i << "]";
}

TEST(Publisher, ASnapshotContainsTheValuesOfTheStore) {
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
  const TransientOffsets& at = transient_offsets();
  ASSERT_EQ(snapshot->body_list->bodies.size(), 3U);
  const char* const names[] = {"arm", "1", "floor"};
  for (std::size_t b = 0; b < 3; b++) {
    const BodyEntry& body = snapshot->body_list->bodies[b];
    const sim::Body& live_body = *rig.world.bodies()[b];
    EXPECT_EQ(body.name, names[b]);
    EXPECT_EQ(snapshot->transient.at(body.enabled_offset), 1);
    ASSERT_EQ(body.joint_offsets.size(), live_body.joints().size());
    ASSERT_EQ(body.joint_names.size(), live_body.joints().size());
    ASSERT_EQ(body.part_offsets.size(), live_body.parts().size());
    for (std::size_t j = 0; j < body.joint_offsets.size(); j++) {
      const std::string path = rig.store.path(live_body.joints()[j]->id());
      EXPECT_EQ(body.joint_names[j], live_body.joints()[j]->name());
      expect_numbers(*snapshot, body.joint_offsets[j] + at.joint_position, rig.read(path + "/position"), path);
      expect_numbers(*snapshot, body.joint_offsets[j] + at.joint_rotation, rig.read(path + "/rotation"), path);
      expect_numbers(*snapshot, body.joint_offsets[j] + at.joint_relrot, rig.read(path + "/relrot"), path);
      expect_numbers(*snapshot, body.joint_offsets[j] + at.joint_offsets, rig.read(path + "/offsets"), path);
    }
    for (std::size_t p = 0; p < body.part_offsets.size(); p++) {
      const std::string path = rig.store.path(live_body.parts()[p]->id());
      expect_numbers(*snapshot, body.part_offsets[p] + at.part_position, rig.read(path + "/position"), path);
      expect_numbers(*snapshot, body.part_offsets[p] + at.part_rotation, rig.read(path + "/rotation"), path);
    }
  }
}

TEST(Publisher, TheBodyListIsSharedUntilBodiesAreAddedOrRemoved) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  const auto publish_body_list = [&] {
    rig.world.step();
    publisher.publish(false, 1);
    return latest.read()->body_list;
  };
  const auto first = publish_body_list();
  rig.send("/physics/part/mass", 2);
  EXPECT_EQ(publish_body_list(), first) << "values do not change the list of bodies";
  ASSERT_TRUE(rig.world.add_body("new").ok());
  const auto second = publish_body_list();
  EXPECT_NE(second, first);
  ASSERT_EQ(second->bodies.size(), 4U);
  EXPECT_EQ(second->bodies[3].name, "new");
  rig.world.remove_body(*rig.world.find_body("arm"));
  const auto third = publish_body_list();
  ASSERT_EQ(third->bodies.size(), 3U);
  EXPECT_EQ(third->bodies[0].name, "1");
  EXPECT_EQ(first->bodies.size(), 3U) << "an old one is still valid for its readers";
}

TEST(Publisher, ARetainedSnapshotIsNotOverwritten) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  publisher.publish(false, 1);
  const auto retained = latest.read();
  const std::vector<double> values_before = retained->transient;
  for (int i = 0; i < 10; i++) {
    rig.world.step();
    publisher.publish(false, 1);
  }
  EXPECT_EQ(retained->tick, 0U);
  EXPECT_EQ(retained->transient, values_before);
  EXPECT_EQ(latest.read()->tick, 10U);
}

TEST(Publisher, TheOverlayIsCapturedWhileItIsOn) {
  const SceneFile scene(R"(
sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 1 })
)");
  Show show(scene.path());
  const auto overlay_size = [&] {
    show.ticks(1);
    return show.link.snapshots.read()->overlay.size();
  };
  EXPECT_EQ(overlay_size(), 0U);
  show.send("/visuals/look/overlay", 1);
  EXPECT_GT(overlay_size(), 0U);
  show.send("/transport/reset");
  EXPECT_GT(overlay_size(), 0U) << "it belongs to the user, not to the scene";
  show.send("/visuals/look/overlay", 0);
  EXPECT_EQ(overlay_size(), 0U);
}

TEST(Publisher, ADisabledBodyIsMarked) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  rig.send("/physics/body/1/enabled", false);
  rig.world.step();
  publisher.publish(false, 1);
  const auto snapshot = latest.read();
  EXPECT_EQ(snapshot->transient.at(snapshot->body_list->bodies[0].enabled_offset), 1);
  EXPECT_EQ(snapshot->transient.at(snapshot->body_list->bodies[1].enabled_offset), 0);
}

}  // namespace
}  // namespace limber::engine::test
