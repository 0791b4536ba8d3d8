// Collada documents on which the mesh reader hangs or runs out of stack are refused; the rest keeps its geometry.
#include "model/mesh_collada.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "model/mesh_load.h"
#include "solids.h"

namespace limber {
namespace {

std::string cleaned(const std::string& text) {
  const Result<std::string> result = clean_collada(text);
  return result ? *result : "refused: " + result.error();
}

std::string document(const std::string& inside) { return "<COLLADA>" + inside + "</COLLADA>"; }

TEST(MeshCollada, KeepsGeometryAndDropsTheRest) {
  EXPECT_EQ(cleaned(document(
                "<asset/><library_effects><a/></library_effects><library_geometries><geometry><extra><x/></extra>"
                "<mesh/></geometry></library_geometries><library_animations/>"
                "<library_visual_scenes><visual_scene><node><instance_geometry url=\"#g\"><bind_material/>"
                "</instance_geometry><extra/></node></visual_scene></library_visual_scenes>")),
            "<COLLADA><asset/><library_geometries><geometry><mesh/></geometry></library_geometries>"
            "<library_visual_scenes><visual_scene><node><instance_geometry url=\"#g\"/></node></visual_scene>"
            "</library_visual_scenes></COLLADA>");
}

TEST(MeshCollada, IndexListsHoldWholeNumbersOnly) {
  const auto list = [](const std::string& p) {
    return cleaned(document("<library_geometries>\n<p>" + p + "</p></library_geometries>"));
  };
  EXPECT_EQ(list("0 1 2\n-3 +4").find("refused"), std::string::npos);
  for (const char* bad : {"0 1.5 2", "0 \x1A 2", "0 x 2", "0 <q/> 2", "<![CDATA[0 1]]>"}) {
    EXPECT_EQ(list(bad).find("refused: line 2"), 0u) << list(bad);
  }
}

TEST(MeshCollada, CountsAreNoLargerThanTheFile) {
  EXPECT_EQ(
      cleaned(document("<library_geometries><v count=\"4294967295\"/></library_geometries>")).find("refused: line 1"),
      0u);
  EXPECT_EQ(cleaned(document("<library_geometries><v count=\"-1\"/></library_geometries>")).find("refused"), 0u);
  EXPECT_EQ(cleaned(document("<library_geometries><v count=\"3\" offset=\"1\"/></library_geometries>")).find("refused"),
            std::string::npos);
}

TEST(MeshCollada, NodesMustNotInstanceThemselves) {
  const auto nodes = [](const std::string& text) {
    return cleaned(document("<library_nodes>" + text + "</library_nodes>"));
  };
  EXPECT_NE(nodes("<node id=\"a\"><instance_node url=\"#a\"/></node>").find("circle"), std::string::npos);
  EXPECT_NE(nodes("<node id=\"a\"><node><instance_node url=\"#b\"/></node></node><node name=\"b\"><instance_node "
                  "url=\"#a\"/></node>")
                .find("circle"),
            std::string::npos);
  EXPECT_EQ(nodes("<node id=\"a\"><instance_node url=\"#b\"/><instance_node url=\"#b\"/></node><node id=\"b\"/>")
                .find("refused"),
            std::string::npos);
  // twice the next one, forty times over, is 2^40 nodes
  std::string bomb;
  for (int i = 0; i < 40; ++i) {
    bomb +=
        fmt::format("<node id=\"n{0}\"><instance_node url=\"#n{1}\"/><instance_node url=\"#n{1}\"/></node>", i, i + 1);
  }
  EXPECT_NE(nodes(bomb + "<node id=\"n40\"/>").find("unfold to more than"), std::string::npos);
}

TEST(MeshCollada, InstancedNodesAreLoaded) {
  // the box in a library node, instanced twice, 3 m apart
  const std::string text = test::dae(test::box({1, 1, 1}), 1, "Z_UP", "");
  const std::string scene = "<library_visual_scenes>";
  const std::string nodes = "<library_nodes><node id=\"part\"><instance_geometry url=\"#g\"/></node></library_nodes>" +
                            scene +
                            "<visual_scene id=\"s\"><node id=\"p\"><instance_node url=\"#part\"/></node><node "
                            "id=\"q\"><translate>3 0 0</translate>"
                            "<instance_node url=\"#part\"/></node></visual_scene></library_visual_scenes>";
  const std::size_t from = text.find(scene);
  const std::size_t to = text.find("<scene>");
  const auto mesh = mesh_from_bytes(text.substr(0, from) + nodes + text.substr(to), MeshFormat::dae, Vec3(1), "m");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_EQ((*mesh)->vertices.size(), 16u);
  EXPECT_NEAR((*mesh)->solid.mass, 2, 1e-6);
}

}  // namespace
}  // namespace limber
