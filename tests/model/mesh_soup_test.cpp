// Tokenizer with line numbers, and triangulation of polygons, checked by area.
#include "model/mesh/triangles.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solids.h"

namespace limber::model {
namespace {

MeshSoup triangulate(const std::vector<Vec3>& outline) {
  MeshSoup soup;
  PolygonTriangulator().triangulate(outline, soup);
  return soup;
}

/// The sum of the triangles' absolute areas; too large if triangles overlap.
double area(const MeshSoup& soup) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < soup.size(); i += 3) {
    sum += glm::length(glm::cross(soup[i + 1] - soup[i], soup[i + 2] - soup[i])) / 2;
  }
  return sum;
}
/// Area of a polygon in the plane z = 0, by the shoelace formula.
double shoelace(const std::vector<Vec3>& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3& a = outline[i];
    const Vec3& b = outline[(i + 1) % outline.size()];
    sum += (a.x * b.y - a.y * b.x) / 2;
  }
  return sum;
}

TEST(MeshSoup, ConvexPolygonsBecomeFans) {
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 0, 0}}).empty());
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), MeshSoup({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(triangulate({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}),
            MeshSoup({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 0, 0}, {2, 1, 0}, {0, 1, 0}}));
}

TEST(MeshSoup, TriangulatesConcavePolygonsWithoutOverlap) {
  // an arrow head (a fan from its first corner would lie outside), a comb and a star, each starting at every corner
  std::vector<Vec3> comb{{0, 0, 0}, {9, 0, 0}};
  for (int i = 9; i > 0; i -= 2) {
    comb.insert(comb.end(), {{i, 5, 0}, {i - 0.6, 5, 0}, {i - 0.8, 1, 0}, {i - 1.0, 1, 0}});
  }
  std::vector<Vec3> star;
  for (int i = 0; i < 14; ++i) {
    const double r = i % 2 == 0 ? 1 : 0.3;
    star.emplace_back(r * std::cos(kPi * i / 7), r * std::sin(kPi * i / 7), 0);
  }
  const std::vector<Vec3> arrow{{0, 0, 0}, {2, -1, 0}, {1, 0, 0}, {2, 1, 0}};
  for (std::vector<Vec3> outline : {arrow, comb, star}) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const MeshSoup soup = triangulate(outline);
      EXPECT_EQ(soup.size(), 3 * (outline.size() - 2));
      EXPECT_NEAR(area(soup), shoelace(outline), 1e-12) << outline.size() << " corners, rotated by " << i;
      for (std::size_t t = 0; t < soup.size(); t += 3) {
        EXPECT_GE(glm::cross(soup[t + 1] - soup[t], soup[t + 2] - soup[t]).z, 0) << "triangle " << t / 3;
      }
      std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    }
  }
}

TEST(MeshSoup, TriangulatesPolygonsWithBridgesToHoles) {
  // a square with a square hole, connected by a bridge that the outline passes twice
  const std::vector<Vec3> outline{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                                  {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
  EXPECT_NEAR(area(triangulate(outline)), 8, 1e-12);
}

TEST(MeshSoup, BoundsTheTimeForHostilePolygons) {
  // a zigzag that crosses itself has hardly any ears: the step limit is reached, and the rest becomes a fan
  std::vector<Vec3> zigzag;
  zigzag.reserve(20'011);
  for (int i = 0; i < 20'011; ++i) zigzag.emplace_back(i * 7919 % 20'011, i * 104'729 % 20'011, i % 3);
  EXPECT_EQ(triangulate(zigzag).size(), 3 * (zigzag.size() - 2));
  const std::vector<Vec3> point(1000, Vec3(1, 2, 3));
  EXPECT_EQ(triangulate(point).size(), 3 * (point.size() - 2));
}

TEST(MeshSoup, WordsHaveLineNumbers) {
  MeshTokenizer words("a b\n\n c\r\nd\re \t f\n", 10);
  const std::pair<const char*, int> expected[] = {{"a", 10}, {"b", 10}, {"c", 12}, {"d", 13}, {"e", 14}, {"f", 14}};
  for (const auto& [word, line] : expected) {
    EXPECT_EQ(words.next(), word);
    EXPECT_EQ(words.line(), line) << word;
  }
  EXPECT_EQ(words.next(), "");
  MeshTokenizer skipping("solid x y z\r\nfacet q\nend");
  EXPECT_EQ(skipping.next(), "solid");
  skipping.skip_line();
  EXPECT_EQ(skipping.next(), "facet");
  EXPECT_EQ(skipping.line(), 2);
  skipping.skip_line();
  EXPECT_EQ(skipping.next(), "end");
}

TEST(MeshSoup, IntegersMustFillTheWord) {
  EXPECT_EQ(parse_integer("12"), 12);
  EXPECT_EQ(parse_integer("+12"), 12);
  EXPECT_EQ(parse_integer("-3"), -3);
  for (const char* bad : {"", "+", "-", "+-1", "1.0", "1x", "0x1", "99999999999999999999"}) {
    EXPECT_FALSE(parse_integer(bad)) << bad;
  }
}

}  // namespace
}  // namespace limber::model
