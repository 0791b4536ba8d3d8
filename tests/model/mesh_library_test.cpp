// Search for mesh files, and the cache of loaded meshes.
#include "model/mesh/library.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "files.h"
#include "model/urdf/import.h"
#include "solids.h"

namespace limber::model {
namespace {

std::string found(const std::string& uri, const std::string& folder, const std::vector<std::string>& packages = {}) {
  const Result<std::string> path = find_mesh(uri, folder, packages);
  return path ? std::filesystem::canonical(*path).string() : "none: " + path.error();
}

TEST(MeshLibrary, FindsEveryFormOfUri) {
  const test::Files files;
  const auto canonical = [](const std::string& path) { return std::filesystem::canonical(path).string(); };
  const std::string mesh = canonical(files.write("ws/arm/meshes/x.stl", "x"));
  const std::string beside = canonical(files.write("ws/arm/urdf/y.stl", "y"));
  const std::string other = canonical(files.write("elsewhere/hand/z.stl", "z"));
  const std::string urdf = files.path("ws/arm/urdf");
  EXPECT_EQ(found("package://arm/meshes/x.stl", urdf), mesh);
  EXPECT_EQ(found("package://other_name/meshes/x.stl", urdf), mesh);
  EXPECT_EQ(found("model://arm/meshes/x.stl", urdf), mesh);
  EXPECT_EQ(found("../meshes/x.stl", urdf), mesh);
  EXPECT_EQ(found("meshes/x.stl", urdf), mesh);
  EXPECT_EQ(found("..\\meshes\\x.stl", urdf), mesh);
  EXPECT_EQ(found(mesh, urdf), mesh);
  EXPECT_EQ(found("file://" + mesh, urdf), mesh);
  EXPECT_EQ(found("$(find arm)/meshes/x.stl", urdf), mesh);
  EXPECT_EQ(found("package://y.stl", urdf), beside);
  EXPECT_EQ(found("y.stl", urdf), beside);
  EXPECT_EQ(found("package://hand/z.stl", urdf, {files.path("elsewhere")}), other);
  EXPECT_EQ(found("package://hand/z.stl", urdf, {files.path("elsewhere/hand")}), other);
}

TEST(MeshLibrary, SearchesTheUrdfsFolderFirst) {
  const test::Files files;
  files.write("a/m.stl", "1");
  const std::string near = std::filesystem::canonical(files.write("a/b/m.stl", "2")).string();
  EXPECT_EQ(found("package://m.stl", files.path("a/b"), {files.path("a")}), near);
}

TEST(MeshLibrary, DecodesEscapesIfTheLiteralFileDoesNotExist) {
  const test::Files files;
  const auto canonical = [](const std::string& path) { return std::filesystem::canonical(path).string(); };
  const std::string blank = canonical(files.write("arm/my arm.stl", "1"));
  EXPECT_EQ(found("package://arm/my%20arm.stl", files.path("arm")), blank);
  const std::string literal = canonical(files.write("arm/my%20arm.stl", "2"));
  EXPECT_EQ(found("package://arm/my%20arm.stl", files.path("arm")), literal);
}

TEST(MeshLibrary, FindsNamesInAnotherLetterCaseLast) {
  const test::Files files;
  const auto canonical = [](const std::string& path) { return std::filesystem::canonical(path).string(); };
  const std::string upper = canonical(files.write("arm/Meshes/Link.STL", "1"));
  const std::string folder = files.path("arm/urdf");
  std::filesystem::create_directories(folder);
  EXPECT_EQ(found("package://arm/meshes/link.stl", folder), upper);
  EXPECT_TRUE(differs_in_case("package://arm/meshes/link.stl", upper));
  EXPECT_TRUE(differs_in_case("../Meshes/link.STL", upper));
  EXPECT_FALSE(differs_in_case("../Meshes/Link.STL", upper));
  EXPECT_FALSE(differs_in_case("package://other/Link.STL", upper));
  const std::string exact = canonical(files.write("link.stl", "2"));
  EXPECT_EQ(found("package://arm/meshes/link.stl", folder), exact) << "an exact name further away comes first";
}

TEST(MeshLibrary, AUrdfThatIsALinkFindsMeshesBesideItsTarget) {
  const test::Files files;
  files.write("model/meshes/Box.stl", test::binary_stl(test::box({1, 1, 1})));
  const std::string target = files.write(
      "model/robot.urdf",
      "<robot name='r'><link name='a'><visual><geometry><mesh filename='meshes/box.stl'/></geometry></visual>"
      "</link></robot>");
  const std::string link = files.write("links/other.txt", "") + ".urdf";
  std::filesystem::create_symlink(target, link);
  MeshLibrary meshes;
  const auto model = import_urdf(link, {}, meshes);
  ASSERT_TRUE(model) << model.error();
  EXPECT_EQ((*model)->links.at(0).visuals.size(), 1u);
  const auto named = [](const Problem& p) { return p.text.find("whose letter case differs") != std::string::npos; };
  EXPECT_TRUE(std::any_of((*model)->problems.begin(), (*model)->problems.end(), named));
}

TEST(MeshLibrary, ErrorListsTheSearchedFolders) {
  const test::Files files;
  const std::string text = found("package://hand/z.stl", files.path(""), {files.path("packages")});
  EXPECT_NE(text.find(files.path("packages")), std::string::npos) << text;
  EXPECT_NE(text.find("--package-path"), std::string::npos) << text;
  EXPECT_NE(found("https://x.org/z.stl", files.path("")).find("network"), std::string::npos);
  EXPECT_NE(found(files.path(""), files.path("")).find("none: "), std::string::npos) << "a folder is not a mesh";
}

TEST(MeshLibrary, CachesMeshesByFileAndScale) {
  const test::Files files;
  const std::string path = files.write("box.stl", test::binary_stl(test::box({1, 2, 3})));
  MeshLibrary library;
  const auto first = library.load(path, Vec3(1));
  const auto again = library.load(path, Vec3(1));
  const auto scaled = library.load(path, Vec3(2));
  ASSERT_TRUE(first && again && scaled);
  EXPECT_EQ(*first, *again);
  EXPECT_NE(*first, *scaled);
  EXPECT_NEAR((*scaled)->unit_inertial.mass, 48, 1e-4);
}

TEST(MeshLibrary, ReloadsAChangedFile) {
  const test::Files files;
  const std::string path = files.write("m.stl", test::binary_stl(test::box({1, 1, 1})));
  MeshLibrary library;
  const auto first = library.load(path, Vec3(1));
  files.write("m.stl", test::binary_stl(test::cylinder(1, 1, 8)));
  const auto second = library.load(path, Vec3(1));
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_EQ((*first)->vertices.size(), 8u) << "holders of the old mesh are not affected";
}

}  // namespace
}  // namespace limber::model
