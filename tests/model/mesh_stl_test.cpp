// STL in the notations of real programs, and the errors for invalid files.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "import_text.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"
#include "solids.h"

namespace limber::model {
namespace {

const MeshSoup kTriangle{{0, 0, 0}, {1, 0, 0}, {0, 0.5, -2}};

std::string read_stl(const std::string& text, MeshSoup* into = nullptr) {
  const Result<MeshSoup> soup = soup_from_stl(text);
  if (soup && into) *into = *soup;
  return soup ? "read" : soup.error();
}

std::string facet(const std::string& vertices, const std::string& normal = "0 0 1") {
  return "facet normal " + normal + "\n outer loop\n" + vertices + " endloop\nendfacet\n";
}

TEST(MeshStl, ReadsAsciiInEveryNotation) {
  const std::string vertices = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 0.5 -2\n";
  std::string old_mac = "solid a\n" + facet(vertices) + "endsolid a\n";
  std::replace(old_mac.begin(), old_mac.end(), '\n', '\r');
  const std::string loud =
      "SOLID A B\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVertex 1 0 0\nVERTEX 0 .5 -2.\nENDLOOP\nENDFACET\n"
      "ENDSOLID A B\n";
  const std::string windows =
      "solid a\r\nfacet normal 0 0 1\r\nouter loop\r\nvertex 0 0 0\r\nvertex 1 0 0\r\nvertex 0 0.5 -2\r\nendloop\r\n"
      "endfacet\r\nendsolid a\r\n";
  const std::string texts[] = {
      "solid a\n" + facet(vertices) + "endsolid a\n",
      "\n  solid\n" + facet(vertices) + "endsolid",
      loud,
      windows,
      old_mac,
      "solid caf\xC3\xA9 facet vertex\n" + facet(vertices) + "endsolid\n",
      "solid a\n" + facet("vertex +0.0e0 0E+5 -0\nvertex 1.0000e+00 0 0\nvertex 0 5e-1 -0.2E1\n") + "endsolid a\n",
      "solid a\n" + facet(vertices, "nan -nan(ind) inf") + "endsolid a\n"};
  for (const std::string& text : texts) {
    MeshSoup soup;
    EXPECT_EQ(read_stl(text, &soup), "read") << text;
    EXPECT_EQ(soup, kTriangle) << text;
  }
}

TEST(MeshStl, MergesSeveralSolids) {
  const test::Solid box = test::box({1, 1, 1});
  const std::string far = test::ascii_stl(box.moved({{5, 0, 0}, quat_identity()}));
  const auto mesh = mesh_from_bytes(test::ascii_stl(box) + "\n" + far, MeshFormat::stl, Vec3(1), "m");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_EQ((*mesh)->vertices.size(), 16u);
  EXPECT_NEAR((*mesh)->unit_inertial.mass, 2, 1e-12);
  test::expect_near((*mesh)->unit_inertial.center, {2.5, 0, 0}, 1e-12);
}

TEST(MeshStl, TriangulatesFacetsWithMoreCorners) {
  MeshSoup soup;
  EXPECT_EQ(read_stl("solid\n" + facet("vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0\n") + "endsolid", &soup),
            "read");
  EXPECT_EQ(soup, MeshSoup({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
}

TEST(MeshStl, AsciiNumbersKeepTheirPrecision) {
  MeshSoup soup;
  EXPECT_EQ(
      read_stl("solid\n" + facet("vertex 0.1 0 0 vertex 1.23456789012345 0 0 vertex 0 1 0\n") + "endsolid", &soup),
      "read");
  EXPECT_EQ(soup.at(0).x, 0.1);
  EXPECT_EQ(soup.at(1).x, 1.23456789012345);
}

TEST(MeshStl, DetectsBinaryByItsLength) {
  test::Solid one;
  one.vertices = kTriangle;
  one.triangles = {0, 1, 2};
  // a header that contains all keywords of ASCII STL
  for (const char* header : {"binary", "solid facet vertex endsolid"}) {
    for (const char* tail : {"", "and more"}) {
      MeshSoup soup;
      EXPECT_EQ(read_stl(test::binary_stl(one, header) + tail, &soup), "read") << header << tail;
      EXPECT_EQ(soup, kTriangle) << header << tail;
    }
  }
  std::string bytes = test::binary_stl(one);
  const float infinite = HUGE_VALF;
  std::memcpy(bytes.data() + 84 + 12, &infinite, 4);
  EXPECT_EQ(read_stl(bytes), "triangle 1 has a vertex that is not finite. Export it again.");
  std::string many(84 + 50 * 2'000'001ul, '\0');
  const std::uint32_t count = 2'000'001;
  std::memcpy(many.data() + 80, &count, 4);
  EXPECT_EQ(read_stl(many), "has more than 2000000 triangles. Simplify it.");
}

TEST(MeshStl, ErrorsHaveALineAndAFix) {
  const std::string good = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 0.5 -2\n";
  const std::string fix = ". Export it again, or as binary STL.";
  const std::pair<std::string, std::string> cases[] = {
      {"solid a\n" + facet(good), "line 9: the ASCII STL ends without 'endsolid'"},
      {"solid a\n" + facet(good) + "fac", "line 9: the ASCII STL ends without 'endsolid'"},
      {"solid a\nfacet normal 0 0 1 outer loop\nvertex 0 0 1e", "line 3: the ASCII STL ends without 'endsolid'"},
      {"solid a\n" + facet("vertex 0 0 0\nvertex 1 0 x\nvertex 0 1 0\n") + "endsolid",
       "line 5: 'x' is not a finite number"},
      {"solid a\n" + facet("vertex 0 0 0\nvertex 1 0 1e999\nvertex 0 1 0\n") + "endsolid",
       "line 5: '1e999' is not a finite number"},
      {"solid a\n" + facet("vertex 0 0 0\nvertex 1 0,5 0\nvertex 0 1 0\n") + "endsolid",
       "line 5: '0,5' is not a finite number"},
      {"solid a\n" + facet("vertex 0 0 0\nvertex 1 0 0\n") + "endsolid", "line 7: a facet has 2 corners, not 3"},
      {"solid a\n" + facet(good + "vertx 0 0 0\n") + "endsolid", "line 7: unexpected 'vertx' in ASCII STL"},
      {"solid a\nendsolid a\n" + facet(good), "line 3: unexpected 'facet' in ASCII STL"}};
  for (const auto& [text, expected] : cases) {
    const std::string error = read_stl(text);
    EXPECT_EQ(error.substr(0, expected.size()), expected) << text;
    EXPECT_EQ(error.substr(std::min(error.size(), error.size() - fix.size())), fix) << error;
  }
}

}  // namespace
}  // namespace limber::model
