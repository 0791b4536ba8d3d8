// Sensors in a reload: changed, added, removed, of another kind, preserved when a body is rebuilt; streamed contacts.
#include "engine/edited.h"
#include "sim/sensors/sensor_list.h"

namespace limber::engine::test {
namespace {

constexpr const char* kSensorShow = R"(
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("ground"))
local body = sim:add_body("box")
local box = body:add_part("box", sim:add_box_shape("brick", vec3(0.2, 0.2, 0.2)), { position = vec3(0, 0, 0.1) })
box:add_zone("near", { radius = 0.5 })
box:add_range_finder("eye", { position = vec3(0, 0, 0), direction = vec3(0, 0, -1) })
--MORE
)";

sim::Sensor* sensor_named(EditedShow& edited, const char* name) { return edited.body("box").sensors().find(name); }
double sensor_value(EditedShow& edited, const char* name, const char* property) {
  const sim::Sensor* const sensor = sensor_named(edited, name);
  const Store& store = edited.world().store();
  return store.values(sensor->id(), store.table(sensor->id()).at(property))[0];
}

TEST(ReloadSensors, AnEditThatChangesNothingChangesNoBit) {
  EditedShow edited(kSensorShow);
  EditedShow control(kSensorShow);
  for (int i = 0; i < 3; i++) {
    edited.show().ticks(5);
    control.show().ticks(5);
    EXPECT_EQ(edited.edit("--MORE", "--MORE\n"), SceneReloader::ApplyResult::applied);
    ASSERT_EQ(edited.show().engine.state_hash(), control.show().engine.state_hash()) << i;
  }
}

TEST(ReloadSensors, ASettingIsChangedInPlace) {
  EditedShow edited(kSensorShow);
  edited.show().ticks(5);
  const NodeId id = sensor_named(edited, "near")->id();
  EXPECT_EQ(edited.edit("radius = 0.5", "radius = 0.25"), SceneReloader::ApplyResult::applied);
  edited.show().ticks(1);
  EXPECT_EQ(sensor_named(edited, "near")->id(), id);
  EXPECT_EQ(sensor_value(edited, "near", "radius"), 0.25);
}

TEST(ReloadSensors, AreAddedRemovedAndChangeTheirKind) {
  EditedShow edited(kSensorShow);
  edited.show().ticks(60);
  EXPECT_NEAR(sensor_value(edited, "eye", "distance"), 0.1, 1e-3);
  EXPECT_EQ(edited.edit("--MORE", "box:add_imu('imu')"), SceneReloader::ApplyResult::applied);
  edited.show().ticks(5);
  const sim::Sensor* const imu = sensor_named(edited, "imu");
  ASSERT_NE(imu, nullptr);
  const Store& store = edited.world().store();
  EXPECT_NEAR(store.values(imu->id(), sim::imu_table().at("specific_force"))[2], 9.81, 0.01);
  EXPECT_NEAR(sensor_value(edited, "eye", "distance"), 0.1, 1e-3) << "the others remain";
  EXPECT_EQ(edited.edit("box:add_zone(\"near\", { radius = 0.5 })", "box:add_touch(\"near\")"),
            SceneReloader::ApplyResult::applied);
  edited.show().ticks(5);
  EXPECT_EQ(sensor_named(edited, "near")->kind(), sim::SensorKind::touch);
  EXPECT_GT(sensor_value(edited, "near", "force"), 1);
  EXPECT_EQ(edited.edit("box:add_imu('imu')", ""), SceneReloader::ApplyResult::applied);
  EXPECT_EQ(sensor_named(edited, "imu"), nullptr);
}

TEST(ReloadSensors, KeepOverridesWhenTheirBodyIsRebuilt) {
  EditedShow edited(kSensorShow);
  edited.show().ticks(5);
  const double range = 3;
  ASSERT_TRUE(edited.world().store().set(sensor_named(edited, "eye")->id(), "range", {&range, 1}));
  EXPECT_EQ(edited.edit("--MORE", "body:add_part('hat', 'brick', { position = vec3(0, 0, 0.4) })"),
            SceneReloader::ApplyResult::applied);
  edited.show().ticks(1);
  EXPECT_EQ(sensor_value(edited, "eye", "range"), 3);
  EXPECT_EQ(&sensor_named(edited, "eye")->part(), edited.body("box").find_part("box"));
}

TEST(StreamedContacts, AreSentAfterEachTick) {
  const SceneFile scene(R"(
sim.gravity = vec3(0, 0, -9.81)
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
local ball = sim:add_body("ball")
ball:add_part("ball", sim:add_sphere_shape("ball", 0.5),
  { position = vec3(0, 0, 0.5), mass = 2, report_contacts = true, stream_contacts = true })
)");
  Show show(scene.path());
  show.ticks(60);
  std::vector<std::string> points;
  for (const std::string& line : show.sent_texts()) {
    if (line.starts_with("/physics/contact/point ")) points.push_back(line);
  }
  EXPECT_GT(points.size(), 50u);
  EXPECT_TRUE(points.back().starts_with("/physics/contact/point ball ball floor floor 19.6")) << points.back();
  EXPECT_TRUE(points.back().ends_with(" 0 0 1")) << points.back();
}

}  // namespace
}  // namespace limber::engine::test
