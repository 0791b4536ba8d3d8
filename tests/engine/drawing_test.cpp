// Render scenes: shapes and their instances, and the appearance values in snapshots.
#include "engine/output/render_scene.h"

#include "engine/show.h"
#include "model/urdf/import.h"

namespace limber::engine::test {
namespace {

TEST(RenderScene, HasAnInstanceForEachGeometryOfEachPart) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  publisher.publish(false, 1);
  const auto now = latest.read();
  const RenderScene& render_scene = *now->render_scene;
  // four parts of arm, two of 1, one floor; two shapes
  ASSERT_EQ(render_scene.instances.size(), 7u);
  EXPECT_EQ(render_scene.shapes.size(), 2u);
  EXPECT_EQ(render_scene.shapes[render_scene.instances[0].shape].geometry.kind, model::ShapeKind::sphere);
  EXPECT_EQ(render_scene.shapes[render_scene.instances[6].shape].geometry.kind, model::ShapeKind::plane);
  EXPECT_EQ(render_scene.instances[3].part_offset, now->body_list->bodies[0].part_offsets[3]);
  EXPECT_EQ(render_scene.instances[4].enabled_offset, now->body_list->bodies[1].enabled_offset);
}

TEST(RenderScene, IsRebuiltOnlyWhenBodiesAreAddedOrRemoved) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  const auto now = [&] {
    rig.world.step();
    publisher.publish(false, 1);
    return latest.read();
  };
  const auto first = now();
  rig.send("/visuals/shape/ball/transparency", 0.5);
  const auto painted = now();
  EXPECT_EQ(painted->render_scene, first->render_scene);
  EXPECT_NE(painted->visuals_version, first->visuals_version);
  EXPECT_EQ(now()->visuals_version, painted->visuals_version) << "nothing was set";
  rig.world.remove_body(*rig.world.find_body("1"));
  EXPECT_EQ(now()->render_scene->instances.size(), 5u);
}

TEST(RenderScene, ReadsMaterialsCameraAndAppearanceFromProperties) {
  Rig rig;
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  rig.send("/visuals/shape/ground/diffuse_color", 0.1, 0.2, 0.3);
  rig.send("/visuals/shape/ball/specular_pow", 77);
  rig.send("/visuals/camera/position", 1, 2, -3);
  rig.send("/visuals/camera/projection", 50, 1.5, 0.1, 60);
  publisher.publish(false, 1);
  auto now = latest.read();
  const auto material = [&](std::size_t piece) {
    return material_of(*now, now->render_scene->shapes[now->render_scene->instances[piece].shape].material);
  };
  EXPECT_EQ(material(6).diffuse_color, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(material(6).ambient_color, Vec3(0.1, 0.2, 0.3)) << "its default is the diffuse color";
  EXPECT_EQ(material(0).diffuse_color, Vec3(0, 0, 1));
  EXPECT_EQ(material(0).specular_pow, 77);
  EXPECT_EQ(material_of(*now, 0).specular_pow, 10) << "0: the defaults of the table";
  const CameraSettings camera = camera_of(*now);
  EXPECT_EQ(camera.position, Vec3(1, 2, -3));
  EXPECT_EQ(camera.fovy, 50);
  EXPECT_EQ(camera.aspect, 1.5);
  EXPECT_EQ(camera.near, 0.1);
  EXPECT_EQ(camera.far, 60);
  AppearanceSettings appearance = appearance_of(*now);
  EXPECT_FALSE(appearance.studio);
  EXPECT_FALSE(appearance.custom_background);
  EXPECT_TRUE(appearance.floor);
  rig.send("/visuals/look/style", "studio");
  rig.send("/visuals/look/mirror", 2);
  rig.send("/visuals/look/floor", false);
  rig.send("/visuals/background", 0.5, 1, 0.25);
  publisher.publish(false, 1);
  now = latest.read();
  appearance = appearance_of(*now);
  EXPECT_TRUE(appearance.studio);
  EXPECT_EQ(appearance.mirror, 2);
  EXPECT_FALSE(appearance.floor);
  EXPECT_TRUE(appearance.custom_background);
  EXPECT_EQ(appearance.background, Vec3(0.5, 1, 0.25));
}

TEST(RenderScene, DrawsCompoundsChildByChildInTheirMaterial) {
  Rig rig;
  model::ShapeModel model;
  model.kind = model::ShapeKind::compound;
  sim::Shape& whole = **rig.world.shapes().add("whole", model);
  ASSERT_TRUE(whole.add_child(*rig.world.shapes().find("ball"), {{0, 0, 1}, quat_identity()}).ok());
  ASSERT_TRUE(whole.add_child(*rig.world.shapes().find("ball"), {{0, 0, 2}, quat_identity()}).ok());
  sim::Body& body = **rig.world.add_body("compound");
  ASSERT_TRUE(body.add_part("a", whole, 0, {}).ok());
  ASSERT_TRUE(body.add_part("b", whole, 0, {}).ok());
  const RenderScene render_scene(rig.world);
  ASSERT_EQ(render_scene.instances.size(), 11u);
  EXPECT_EQ(render_scene.shapes.size(), 4u) << "shared by both parts";
  EXPECT_EQ(render_scene.instances[8].origin.position.z, 2);
  EXPECT_EQ(render_scene.shapes[render_scene.instances[8].shape].material, 3u) << "the compound's, not the child's";
}

TEST(RenderScene, DrawsVisualsOfAFileInTheirOwnColors) {
  Rig rig;
  const auto imported = model::import_urdf(std::string(LIMBER_SOURCE_DIR) + "/urdf/arm6.urdf", {});
  ASSERT_TRUE(imported.ok());
  const std::shared_ptr<const model::BodyModel>& model = *imported;
  ASSERT_TRUE(rig.world.add_body(model, "one", {}).ok());
  const std::size_t before = RenderScene(rig.world).shapes.size();
  ASSERT_TRUE(rig.world.add_body(model, "two", {}).ok());
  Latest<Snapshot> latest;
  Publisher publisher(rig.world, latest);
  publisher.publish(false, 1);
  const auto now = latest.read();
  EXPECT_EQ(now->render_scene->shapes.size(), before) << "bodies of one model share their render shapes";
  std::size_t visuals = 0;
  for (const model::LinkModel& link : model->links) visuals += link.visuals.size();
  ASSERT_EQ(now->render_scene->instances.size(), 7 + 2 * visuals);
  const RenderShape& render_shape = now->render_scene->shapes[now->render_scene->instances[7].shape];
  EXPECT_EQ(render_shape.geometry.mesh, model->links[0].visuals[0].shape.mesh) << "the mesh itself, not a copy";
  const sim::Shape& shape = *rig.world.shapes().find(sim::visual_shape_name(*model, model->links[0], 0));
  EXPECT_EQ(material_of(*now, render_shape.material).diffuse_color,
            vec3_at(rig.store.values(shape.id(), sim::Shape::table().at("diffuse_color"))));
}

}  // namespace
}  // namespace limber::engine::test
