// OBJ in the notations of real programs, and the errors for invalid files.
#include <gtest/gtest.h>

#include "model/mesh/load.h"
#include "model/mesh/triangles.h"
#include "solids.h"

namespace limber::model {
namespace {

std::string read_obj(const std::string& text, MeshSoup* into = nullptr) {
  const Result<MeshSoup> soup = soup_from_obj(text);
  if (soup && into) *into = *soup;
  return soup ? "read" : soup.error();
}

TEST(MeshObj, ReadsEveryNotation) {
  const MeshSoup expected{{1, 2, 3}, {2, 2, 3}, {1, 4, 3}};
  const std::string vertices = "v 1 2 3\nv 2 2 3\nv 1 4 3\n";
  const std::string texts[] = {vertices + "f 1 2 3\n",
                               vertices + "f 1 2 3",
                               vertices + "f 1/1 2/2 3/3\n",
                               vertices + "f 1//1 2//1 3//1\n",
                               vertices + "f 1/4/1 2/5/1 3/6/1\n",
                               vertices + "f -3 -2 -1\n",
                               vertices + "f -3/-1/-1 2//-1 +3\n",
                               vertices + "f 1 \\\n2 \\\r\n 3\n",
                               "f 1 2 3\n" + vertices,
                               "v 1 2 \\\n3\nv\t2  2\t3 \nv 1e0 4.000 .3E+1\nf 1 2 3",
                               "v 1 2 3\r\nv 2 2 3\r\nv 1 4 3\r\n\r\nf 1 2 3\r\n",
                               "v 1 2 3\rv 2 2 3\rv 1 4 3\rf 1 2 3\r",
                               "  v 1 2 3 # one\n # v 9 9 9\n\tv 2 2 3\n#\\\nv 1 4 3#two\n f 1 2 3 # all",
                               "v 1 2 3 1\nv 4 4 6 2\nv 1 4 3 1.0\nf 1 2 3\n",
                               "v 1 2 3 0.5 0.5 1\nv 2 2 3 0 0 0\nv 1 4 3 1 1 1\nf 1 2 3\n",
                               "mtllib a b.mtl\no x\ng y z\ns off\nusemtl C:\\\nvn 0 0 1\nvt 0 0\nvp 1\nl 1 2\np 1\n"
                               "curv 0 1 1 2\nfoo\n" +
                                   vertices + "f 1 2 3\nf\nf 1\nf 1 2\nend"};
  for (const std::string& text : texts) {
    MeshSoup soup;
    EXPECT_EQ(read_obj(text, &soup), "read") << text;
    EXPECT_EQ(soup, expected) << text;
  }
}

TEST(MeshObj, NegativeIndicesAreRelativeToTheFace) {
  MeshSoup soup;
  EXPECT_EQ(read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nf -3 -2 -1\n", &soup), "read");
  EXPECT_EQ(soup, MeshSoup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}}));
}

TEST(MeshObj, PolygonsFormAClosedSolid) {
  // an L-shaped prism, 3 m high: two hexagonal ends and six quads; a fan would cover area outside the L
  const double x[] = {2, 2, 0, 0, 1, 1};
  const double y[] = {0, 2, 2, 1, 1, 0};
  std::string text;
  for (const int z : {0, 3}) {
    for (int i = 0; i < 6; ++i) text += fmt::format("v {} {} {}\n", x[i], y[i], z);
  }
  text += "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
  for (int i = 1; i <= 6; ++i) text += fmt::format("f {} {} {} {}\n", i, i % 6 + 1, i % 6 + 7, i + 6);
  const auto mesh = mesh_from_bytes(text, MeshFormat::obj, Vec3(1), "m");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_TRUE((*mesh)->closed);
  EXPECT_NEAR((*mesh)->unit_inertial.mass, 9, 1e-12);
  EXPECT_EQ((*mesh)->triangles.size(), 3u * (4 + 4 + 12));
  double area = 0;
  for (std::size_t i = 0; i < (*mesh)->triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) { return (*mesh)->vertices[(*mesh)->triangles[i + k]]; };
    area += glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
  }
  EXPECT_NEAR(area, 3 + 3 + 8 * 3, 1e-12);
}

TEST(MeshObj, NumbersKeepTheirPrecision) {
  MeshSoup soup;
  EXPECT_EQ(read_obj("v 0.1 1.23456789012345 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &soup), "read");
  EXPECT_EQ(soup.at(0), Vec3(0.1, 1.23456789012345, 0));
}

TEST(MeshObj, ErrorsHaveALineAndAFix) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::pair<std::string, std::string> cases[] = {
      {v + "f 1 2 4\n", "line 4: a face uses vertex 4, but there are 3"},
      {v + "f 1 \\\n2 \\\n4\n", "line 4: a face uses vertex 4, but there are 3"},
      {v + "\r\n\nf 1 2 3\nf 0 1 2\n", "line 7: a face uses vertex 0, but there are 3"},
      {v + "f -1 -2 -4\nv 0 0 1\n", "line 4: a face uses vertex -4, but there are 3"},
      {v + "f 1 2 3x\n", "line 4: '3x' is not a corner of a face"},
      {v + "f 1 2 3/x\n", "line 4: '3/x' is not a corner of a face"},
      {v + "f 1 2 /3\n", "line 4: '/3' is not a corner of a face"},
      {v + "f 1 2 99999999999999999999\n", "line 4: '99999999999999999999' is not a corner of a face"},
      {v + "v 1 2\n", "line 4: a vertex has fewer than three coordinates"},
      {v + "v 1 nan 2\n", "line 4: 'nan' is not a finite number"},
      {v + "v 1 2 -inf\n", "line 4: '-inf' is not a finite number"},
      {v + "v 1 1,5 2\n", "line 4: '1,5' is not a finite number"},
      {v + "v 1 1 2 0\n", "line 4: '0' is not a weight of a vertex"},
      {v + "v 1e300 1 2 1e-300\n", "line 4: a vertex is not finite"},
      {v + "v \x1b[31m 1 2\n", "line 4: '\\x1b[31m' is not a finite number"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(read_obj(text), expected + ". Export it again, or as binary STL.") << text;
  }
}

}  // namespace
}  // namespace limber::model
