// Cache of models: the same file gives one shared model; a changed file, changed mesh or other options a new one.
#include "model/model_library.h"

#include <array>
#include <thread>

#include <gtest/gtest.h>

#include "files.h"
#include "solids.h"

namespace limber::model {
namespace {

constexpr const char* kRobot =
    R"(<robot name="r"><link name="a"><collision><geometry><mesh filename="m.stl"/></geometry></collision></link>
<link name="b"/><joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>)";

TEST(ModelLibrary, CachesModelsByFileAndOptions) {
  const test::Files files;
  files.write("m.stl", test::binary_stl(test::box({1, 1, 1})));
  const std::string path = files.write("r.urdf", kRobot);
  ModelLibrary library;
  const auto a = library.load(path);
  const auto b = library.load(path);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(*a, *b);
  ASSERT_EQ((*a)->links[0].collisions.size(), 1u);
  ImportOptions free;
  free.fixed_base = false;
  const auto c = library.load(path, free);
  ASSERT_TRUE(c);
  EXPECT_NE(*a, *c);
  EXPECT_NEAR((*c)->links[0].inertial.mass, 1000, 1e-2);
  EXPECT_EQ((*a)->links[0].collisions[0].shape.mesh, (*c)->links[0].collisions[0].shape.mesh);
}

TEST(ModelLibrary, ReimportsChangedFiles) {
  const test::Files files;
  files.write("m.stl", test::binary_stl(test::box({1, 1, 1})));
  const std::string path = files.write("r.urdf", kRobot);
  ModelLibrary library;
  const auto first = library.load(path);
  files.write("m.stl", test::binary_stl(test::cylinder(1, 1, 8)));
  const auto mesh_changed = library.load(path);
  files.write("r.urdf", R"(<robot name="new"><link name="a"/></robot>)");
  const auto urdf_changed = library.load(path);
  ASSERT_TRUE(first && mesh_changed && urdf_changed);
  EXPECT_NE(*first, *mesh_changed);
  EXPECT_EQ((*mesh_changed)->links[0].collisions[0].shape.mesh->vertices.size(), 18u);
  EXPECT_EQ((*urdf_changed)->name, "new");
}

TEST(ModelLibrary, EqualContentHasTheSameHashInAnyLibrary) {
  const test::Files files;
  files.write("m.stl", test::binary_stl(test::box({1, 1, 1})));
  const std::string path = files.write("r.urdf", kRobot);
  const auto content = [](const std::string& file, const ImportOptions& options = {}) {
    ModelLibrary library;
    const auto model = library.load(file, options);
    EXPECT_TRUE(model.ok());
    return model ? (*model)->content_hash : 0;
  };
  const std::uint64_t first = content(path);
  EXPECT_EQ(content(path), first);
  ImportOptions free;
  free.fixed_base = false;
  EXPECT_NE(content(path, free), first);
  files.write("m.stl", test::binary_stl(test::cylinder(1, 1, 8)));
  const std::uint64_t other_mesh = content(path);
  EXPECT_NE(other_mesh, first);
  files.write("m.stl", test::binary_stl(test::box({1, 1, 1})));
  EXPECT_EQ(content(path), first);
  const test::Files elsewhere;  // a folder without the mesh
  EXPECT_NE(content(elsewhere.write("r.urdf", kRobot)), first);
}

TEST(ModelLibrary, SharesOneModelBetweenThreads) {
  const test::Files files;
  files.write("m.stl", test::binary_stl(test::capsule(1, 1, 64)));
  const std::string path = files.write("r.urdf", kRobot);
  ModelLibrary library;
  std::array<std::shared_ptr<const BodyModel>, 4> got;
  std::array<std::thread, 4> threads;
  for (std::size_t i = 0; i < 4; ++i) {
    threads[i] = std::thread([&, i] {
      const auto model = library.load(path);
      if (model) got[i] = *model;
    });
  }
  for (std::thread& t : threads) t.join();
  ASSERT_TRUE(got[0]);
  for (const auto& model : got) EXPECT_EQ(model, got[0]);
}

TEST(ModelLibrary, ReportsAMissingFileEachTime) {
  ModelLibrary library;
  for (int i = 0; i < 2; ++i) {
    const auto none = library.load("no_such.urdf");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().find("no_such.urdf"), std::string::npos);
  }
}

}  // namespace
}  // namespace limber::model
