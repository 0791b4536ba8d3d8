// Collada reader: every kind of primitive, source, node and instance, and the errors for invalid documents.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "import_text.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"
#include "solids.h"

namespace limber::model {
namespace {

std::string read_collada(const std::string& text, MeshSoup* into = nullptr) {
  const Result<MeshSoup> soup = soup_from_collada(text);
  if (soup && into) *into = *soup;
  return soup ? "read" : soup.error();
}
MeshSoup soup_of(const std::string& text) {
  MeshSoup soup;
  EXPECT_EQ(read_collada(text, &soup), "read") << text;
  return soup;
}

const char* const kSource =
    "<source id='p'><float_array id='a' count='15'>0 0 0  2 0 0  2 1 0  0 1 0  1 0.5 3</float_array><technique_common>"
    "<accessor source='#a' count='5' stride='3'><param name='X'/><param name='Y'/><param name='Z'/></accessor>"
    "</technique_common></source>";
const char* const kVertices = "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>";
const char* const kInput = "<input semantic='VERTEX' source='#v' offset='0'/>";
const char* const kShape = "<instance_geometry url='#g'/>";
const Vec3 kA{0, 0, 0}, kB{2, 0, 0}, kC{2, 1, 0}, kD{0, 1, 0}, kTop{1, 0.5, 3};

/// A document with this mesh, the contents of its one node (on line 5), and additional libraries.
std::string document(const std::string& mesh, const std::string& node = kShape, const std::string& libraries = "") {
  return "<COLLADA><library_geometries><geometry id='g'><mesh>" + mesh +
         "</mesh></geometry></library_geometries>\n\n\n\n<library_visual_scenes><visual_scene id='s'><node>" + node +
         "</node></visual_scene></library_visual_scenes>" + libraries +
         "<scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}
/// A document with a primitive on the five points A B C D and the top.
std::string primitive(const std::string& text) { return document(std::string(kSource) + kVertices + text); }
/// A document with one triangle with corners on the axes, in a node with these transforms.
std::string placed(const std::string& node) {
  return document(
      "<source id='p'><float_array id='a'>1 0 0 0 1 0 0 0 1</float_array><technique_common><accessor source='#a' "
      "count='3' stride='3'/></technique_common></source>" +
          std::string(kVertices) + "<triangles>" + kInput + "<p>0 1 2</p></triangles>",
      node);
}

void expect_soup(const MeshSoup& soup, const MeshSoup& expected, const std::string& label) {
  ASSERT_EQ(soup.size(), expected.size()) << label;
  for (std::size_t i = 0; i < soup.size(); ++i) {
    EXPECT_LT(glm::length(soup[i] - expected[i]), 1e-12)
        << label << ", corner " << i << ": " << soup[i].x << " " << soup[i].y << " " << soup[i].z;
  }
}

TEST(MeshCollada, ReadsEveryPrimitive) {
  const MeshSoup square{kA, kB, kC, kA, kC, kD};
  const std::string in = kInput;
  const std::string more = "<input semantic='NORMAL' source='#n' offset='1'/>";
  const std::pair<std::string, MeshSoup> cases[] = {
      {"<triangles count='2'>" + in + "<p>0 1 2 0 2 3</p></triangles>", square},
      {"<triangles count='2'>" + in + "<p>0 1 2</p><p>0 2 3</p></triangles>", square},
      {"<triangles>" + in + "<p>0 1 2 <!-- a remark -->0\n\t+2 3</p></triangles>", square},
      {"<triangles count='2'>" + more + in + "<p>0 9 1 9 2 9 0 9 2 9 3 9</p></triangles>", square},
      {"<triangles count='2'><input semantic='VERTEX' source='#v' offset='2'/>" + more +
           "<p>7 9 0 7 9 1 7 9 2 7 9 0 7 9 2 7 9 3</p></triangles>",
       square},
      {"<polylist count='1'>" + in + "<vcount>4</vcount><p>0 1 2 3</p></polylist>", square},
      {"<polylist count='2'>" + in + "<vcount>3 3</vcount><p>0 1 2 0 2 3</p></polylist>", square},
      {"<polylist count='4'>" + in + "<vcount>2 4 1 0</vcount><p>4 4 0 1 2 3 4</p></polylist>", square},
      {"<polygons count='1'>" + in + "<p>0 1 2 3</p></polygons>", square},
      {"<polygons count='2'>" + in + "<p>0 1 2</p><p>0 2 3</p></polygons>", square},
      {"<polygons count='1'>" + in + "<ph><p>0 1 2 3</p><h>4 4 4</h></ph></polygons>", square},
      {"<trifans count='1'>" + in + "<p>0 1 2 3</p></trifans>", square},
      {"<trifans count='2'>" + in + "<p>0 1 2</p><p>0 2 3</p></trifans>", square},
      {"<tristrips count='1'>" + in + "<p>0 1 3 2</p></tristrips>", {kA, kB, kD, kB, kC, kD}},
      {"<tristrips count='2'>" + in + "<p>0 1 3 2 4</p><p>0 1 2</p></tristrips>",
       {kA, kB, kD, kB, kC, kD, kD, kC, kTop, kA, kB, kC}},
      {"<lines count='1'>" + in + "<p>0 1</p></lines><triangles count='0'>" + in + "</triangles>", {}}};
  for (const auto& [text, expected] : cases) expect_soup(soup_of(primitive(text)), expected, text);
}

TEST(MeshCollada, StripsOfABoxFormAClosedSurface) {
  // one strip of eight triangles around the box, then bottom and top; every second triangle has the opposite winding
  const char* source =
      "<source id='p'><float_array id='a'>0 0 0 1 0 0 1 2 0 0 2 0 0 0 3 1 0 3 1 2 3 0 2 3</float_array>"
      "<technique_common><accessor source='#a' count='8' stride='3'/></technique_common></source>";
  const auto mesh = mesh_from_bytes(document(std::string(source) + kVertices + "<tristrips>" + kInput +
                                             "<p>4 0 5 1 6 2 7 3 4 0</p><p>0 3 1 2</p><p>4 5 7 6</p></tristrips>"),
                                    MeshFormat::dae, Vec3(1), "m");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_TRUE((*mesh)->closed);
  EXPECT_NEAR((*mesh)->unit_inertial.mass, 6, 1e-12);
  test::expect_near((*mesh)->unit_inertial.center, {0.5, 1, 1.5}, 1e-12);
}

TEST(MeshCollada, AccessorsSelectTheCoordinates) {
  const auto with = [](const std::string& array, const std::string& accessor) {
    return document("<source id='p'><float_array id='a'>" + array + "</float_array><technique_common><accessor " +
                    accessor + "</accessor></technique_common></source>" + kVertices + "<triangles>" + kInput +
                    "<p>0 1 2</p></triangles>");
  };
  const MeshSoup expected{{1, 2, 3}, {4, 5, 6}, {7, 8, 9.5}};
  const std::string xyz = "<param name='X'/><param name='Y'/><param name='Z'/>";
  const std::pair<std::string, std::string> cases[] = {
      {"1 2 3 4 5 6 7 8 9.5", "source='#a' count='3' stride='3'>" + xyz},
      {"1 2 3 4 5 6 7 8 9.5", "source='#a' count='3' stride='3'>"},
      {"1 2 3 4 5 6 7 8 9.5", "source='#gone' count='3' stride='3'><param/><param/><param/>"},
      {"3 2 1 6 5 4 9.5 8 7", "source='#a' count='3' stride='3'><param name='Z'/><param name='Y'/><param name='X'/>"},
      {"9 9 1 2 3 0 4 5 6 0 7 8 9.5", "source='#a' count='3' stride='4' offset='2'>" + xyz + "<param name='W'/>"},
      {"0 1 2 3 0 4 5 6 0 7 8 9.5", "source='#a' count='3' stride='4'><param/>" + xyz}};
  for (const auto& [array, accessor] : cases) expect_soup(soup_of(with(array, accessor)), expected, accessor);
  EXPECT_EQ(read_collada(with("1 2 3 4 5 6 7 8", "source='#a' count='3' stride='3'>" + xyz)),
            "line 1: an accessor has 3 points, too many for its 8 numbers. Export it again, or as binary STL.");
  EXPECT_EQ(read_collada(with("1 2 3 4 5 6", "source='#a' count='3' stride='2'>")),
            "line 1: an accessor of positions has no X, Y and Z. Export it again, or as binary STL.");
}

TEST(MeshCollada, AppliesTransformsInOrder) {
  // the transformed corners (1 0 0), (0 1 0) and (0 0 1), computed by hand
  const std::string shape = kShape;
  const double h = std::sqrt(0.5);
  const std::pair<std::string, MeshSoup> cases[] = {
      {"<translate>10 20 30</translate>" + shape, {{11, 20, 30}, {10, 21, 30}, {10, 20, 31}}},
      {"<scale>2 3 4</scale>" + shape, {{2, 0, 0}, {0, 3, 0}, {0, 0, 4}}},
      {"<rotate>0 0 1 90</rotate>" + shape, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}},
      {"<rotate>0 0 5 45</rotate>" + shape, {{h, h, 0}, {-h, h, 0}, {0, 0, 1}}},
      {"<translate>10 0 0</translate><rotate>0 0 1 90</rotate><scale>2 3 4</scale>" + shape,
       {{10, 2, 0}, {7, 0, 0}, {10, 0, 4}}},
      {"<scale>2 3 4</scale><rotate>0 0 1 90</rotate><translate>10 0 0</translate>" + shape,
       {{0, 33, 0}, {-2, 30, 0}, {0, 30, 4}}},
      {"<matrix>0 0 1 5  1 0 0 6  0 1 0 7  0 0 0 1</matrix>" + shape, {{5, 7, 7}, {5, 6, 8}, {6, 6, 7}}},
      {"<translate>5 0 0</translate><node><scale>2 2 2</scale>" + shape + "</node>", {{7, 0, 0}, {5, 2, 0}, {5, 0, 2}}},
      // mirroring flips the winding
      {"<scale>1 1 -1</scale>" + shape, {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}},
      // from (0 0 5) along +x with z up: its -z is +x, its x is -y
      {"<lookat>0 0 5  3 0 5  0 0 2</lookat>" + shape, {{0, -1, 5}, {0, 0, 6}, {-1, 0, 5}}},
      {shape + "<translate>1 0 0</translate><rotate>0 0 0 90</rotate>", {{2, 0, 0}, {1, 1, 0}, {1, 0, 1}}}};
  for (const auto& [node, expected] : cases) expect_soup(soup_of(placed(node)), expected, node);
}

TEST(MeshCollada, UnitsScaleTheWholeScene) {
  std::string text = placed("<translate>100 0 0</translate>" + std::string(kShape));
  text.insert(9, "<asset><up_axis>Y_UP</up_axis><unit meter='0.01'/></asset>");
  expect_soup(soup_of(text), {{1.01, 0, 0}, {1, 0.01, 0}, {1, 0, 0.01}}, "centimeters");
  std::string comma = text;
  comma.replace(comma.find("0.01"), 4, "0,010000");
  comma.replace(comma.find("100 0 0"), 7, "1,00e2 0,0 -0,000");
  expect_soup(soup_of(comma), soup_of(text), "a decimal comma");
  for (const char* bad : {"0", "-1", "inf", "x", "1,0.1", ""}) {
    std::string invalid = text;
    invalid.replace(invalid.find("0.01"), 4, bad);
    EXPECT_EQ(read_collada(invalid),
              fmt::format("line 1: meter='{}' is invalid. Export it again, or as binary STL.", bad));
  }
}

TEST(MeshCollada, ReadsEveryKindOfInstance) {
  const MeshSoup one{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto with = [](const std::string& node, const std::string& libraries) {
    std::string text = placed(node);
    return text.insert(text.find("<scene>"), libraries);
  };
  const std::string skin =
      "<library_controllers><controller id='c'><skin source='#g'><bind_shape_matrix>2 0 0 0 0 2 0 0 0 0 "
      "2 0 0 0 0 1</bind_shape_matrix></skin></controller></library_controllers>";
  expect_soup(soup_of(with("<instance_controller url='#c'/>", skin)), one, "a skin");
  const std::string morph =
      "<library_controllers><controller id='c'><morph source='#g'/></controller><controller "
      "id='d'><skin source='#c'/></controller></library_controllers>";
  expect_soup(soup_of(with("<instance_controller url='#d'/>", morph)), one, "a skin of a morph");
  const std::string library =
      "<library_nodes><node {}><translate>0 0 7</translate>" + std::string(kShape) + "</node></library_nodes>";
  const MeshSoup above{{1, 0, 7}, {0, 1, 7}, {0, 0, 8}};
  for (const char* key : {"id='n'", "sid='n'", "name='n'"}) {
    expect_soup(soup_of(with("<instance_node url='#n'/>", fmt::format(fmt::runtime(library), key))), above, key);
  }
  expect_soup(soup_of(with("<node id='g'/>" + std::string(kShape), "")), one, "a node with a geometry's id");
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
  EXPECT_NEAR((*mesh)->unit_inertial.mass, 2, 1e-12);
  test::expect_near((*mesh)->unit_inertial.center, {1.5, 0, 0}, 1e-12);
}

TEST(MeshCollada, ReadsOnlyTheActiveScene) {
  // a second scene, a second geometry with the same ids, materials, animations, cameras and extras
  std::string text = placed(
      "<instance_geometry url='#g'><bind_material/></instance_geometry><extra><node><skew>1</skew>"
      "</node></extra><instance_camera url='#none'/><instance_light url='#none'/>");
  text.insert(text.find("<geometry "),
              "<geometry id='h'><mesh><source id='p'><float_array id='a'>x</float_array>"
              "</source></mesh></geometry>");
  text.insert(text.find("<visual_scene "),
              "<visual_scene id='t'><node><instance_geometry url='#h'/></node>"
              "</visual_scene>");
  text.insert(9,
              "<library_animations><p>x</p></library_animations><library_effects><node><translate>x</translate>"
              "</node></library_effects>");
  text.replace(text.find("<node><translate>x"), 6, "<what><node>");
  text.replace(text.find("</node></library_effects>"), 7, "</node></what>");
  text.replace(text.find("<what>"), 6, "<extra>");
  text.replace(text.find("</what>"), 7, "</extra>");
  expect_soup(soup_of(text), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, text);
  // without <scene>, the first visual scene
  text.erase(text.find("<visual_scene id='t'"), text.find("<visual_scene id='s'") - text.find("<visual_scene id='t'"));
  text.erase(text.find("<scene>"), std::string("<scene><instance_visual_scene url='#s'/></scene>").size());
  expect_soup(soup_of(text), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, text);
}

TEST(MeshCollada, RejectsIndexListsWithNonIntegers) {
  const auto list = [](const std::string& p) {
    return read_collada(primitive("<triangles>" + std::string(kInput) + "\n<p>" + p + "</p></triangles>"));
  };
  EXPECT_EQ(list("0 1 2\n3 +4 0"), "read");
  for (const char* bad : {"0 1.5 2", "0 x 2", "0 <q/> 2", "<![CDATA[0 1 2]]>", "0 1 99999999999999999999"}) {
    EXPECT_EQ(list(bad), "line 2: <p> must contain integers only. Export it again, or as binary STL.") << bad;
  }
  EXPECT_EQ(list("0 1\n 2\n\n x"), "line 5: <p> must contain integers only. Export it again, or as binary STL.");
  EXPECT_EQ(list("0 \x1A 2").find("line 2: "), 0u) << list("0 \x1A 2");
}

TEST(MeshCollada, ErrorsHaveALineAndAFix) {
  const std::string in = kInput;
  const std::string shape = kShape;
  const std::pair<std::string, std::string> cases[] = {
      {primitive("<triangles>" + in + "\n<p>0 1\n5</p></triangles>"), "line 3: point 5 not found; there are 5"},
      {primitive("<triangles>" + in + "<p>0 1 -1</p></triangles>"), "line 1: point -1 not found; there are 5"},
      {primitive("<triangles>" + in + "<p>0 1 2 3</p></triangles>"),
       "line 1: <triangles> contains 4 corners, expected a multiple of 3"},
      {primitive("<triangles count='2'>" + in + "<p>0 1 2</p></triangles>"),
       "line 1: <triangles> has count='2', but contains 1"},
      {primitive("<triangles count='4294967295'>" + in + "<p>0 1 2</p></triangles>"),
       "line 1: count='4294967295' is invalid"},
      {primitive("<trifans count='-1'>" + in + "<p>0 1 2</p></trifans>"), "line 1: count='-1' is invalid"},
      {primitive("<triangles><input semantic='VERTEX' source='#v' offset='1001'/><p>0 1 2</p></triangles>"),
       "line 1: offset='1001' is invalid"},
      {primitive("<triangles><input semantic='VERTEX' source='#v' offset='1'/><p>0 1 2</p></triangles>"),
       "line 1: <p> contains 3 numbers, expected a multiple of 2"},
      {primitive("<triangles><input semantic='NORMAL' source='#p' offset='0'/><p>0 1 2</p></triangles>"),
       "line 1: <triangles> has no vertex positions"},
      {primitive("<triangles><input semantic='VERTEX' source='#w' offset='0'/><p>0 1 2</p></triangles>"),
       "line 1: vertices '#w' not found"},
      {primitive("<polylist>" + in + "<vcount>3\n3</vcount><p>0 1 2 3</p></polylist>"),
       "line 2: <vcount> requires more corners than the 4 in <p>"},
      {primitive("<polylist>" + in + "<vcount>3</vcount><p>0 1 2 3</p></polylist>"),
       "line 1: <vcount> requires 3 corners, but <p> contains 4"},
      {primitive("<polylist>" + in + "<vcount>3 y</vcount><p>0 1 2 3</p></polylist>"),
       "line 1: <vcount> must contain integers only"},
      {placed("<skew>1 2 3 4 5 6 7</skew>" + shape), "line 5: <skew> is not supported"},
      {placed("<translate>1 2</translate>" + shape), "line 5: <translate> contains 2 numbers, expected 3"},
      {placed("<scale>1 2 nan</scale>" + shape), "line 5: 'nan' is not a finite number"},
      {placed("<instance_geometry url='#h'/>"), "line 5: geometry '#h' not found"},
      {placed("<instance_controller url='#g'/>"), "line 5: geometry '#g' not found"},
      {placed("<instance_node url='#h'/>"), "line 5: node '#h' not found"},
      {"<COLLADA>\n</COLLADA>", "line 1: no visual scene found"},
      {"\n<COLADA/>", "line 1: the XML is not a Collada document"},
      {document("<source id='p'/>" + std::string(kVertices) + "<triangles>" + in + "<p>0 1 2</p></triangles>"),
       "line 1: a source has no <accessor>"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(read_collada(text), expected + ". Export it again, or as binary STL.") << text;
  }
}

TEST(MeshCollada, RejectsCyclesOfNodes) {
  const auto nodes = [](const std::string& text) {
    std::string whole = placed(kShape);
    return read_collada(whole.insert(9, "<library_nodes>" + text + "</library_nodes>"));
  };
  EXPECT_NE(nodes("<node id=\"a\"><instance_node url=\"#a\"/></node>").find("cycle"), std::string::npos);
  EXPECT_NE(nodes("<node id=\"a\"><node><instance_node url=\"#b\"/></node></node><node name=\"b\"><instance_node "
                  "url=\"#a\"/></node>")
                .find("cycle"),
            std::string::npos);
  EXPECT_EQ(nodes("<node id=\"a\"><instance_node url=\"#b\"/><instance_node url=\"#b\"/></node><node id=\"b\"/>"),
            "read");
  // 40 nodes that each instance the next one twice are 2^40 instances
  std::string bomb;
  for (int i = 0; i < 40; ++i) {
    bomb +=
        fmt::format("<node id=\"n{0}\"><instance_node url=\"#n{1}\"/><instance_node url=\"#n{1}\"/></node>", i, i + 1);
  }
  EXPECT_NE(nodes(bomb + "<node id=\"n40\"/>").find("expand to more than 100000"), std::string::npos);
}

TEST(MeshCollada, RejectsTooManyInstancedTriangles) {
  // 2000 instances of 2000 triangles: neither number is large, but the product exceeds the limit
  std::string shapes, corners;
  for (int i = 0; i < 2000; ++i) shapes += kShape, corners += "0 1 2 ";
  const auto with = [&](const std::string& instances) {
    return read_collada(document(
        std::string(kSource) + kVertices + "<triangles>" + kInput + "<p>" + corners + "</p></triangles>", instances));
  };
  EXPECT_EQ(with(kShape), "read");
  EXPECT_EQ(with(shapes), "has more than 2000000 triangles. Simplify it.");
}

}  // namespace
}  // namespace limber::model
