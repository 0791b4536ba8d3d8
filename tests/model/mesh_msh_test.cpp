// MSH files, MuJoCo's binary meshes.
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "model/mesh/load.h"

namespace limber::model {
namespace {

template <class T>
void append(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}

// a tetrahedron with edges of 1 m along the axes; one normal and one texture coordinate
std::string tetrahedron() {
  std::string out;
  for (const int count : {4, 1, 1, 4}) append(out, count);
  for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) append(out, v);
  for (const float n : {0.f, 0.f, 1.f, 0.f, 0.f}) append(out, n);
  for (const int corner : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) append(out, corner);
  return out;
}

TEST(MeshMsh, ReadsATetrahedron) {
  const auto mesh = mesh_from_bytes(tetrahedron(), MeshFormat::msh, Vec3(2), "t");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_EQ((*mesh)->vertices.size(), 4u);
  EXPECT_EQ((*mesh)->triangles.size(), 12u);
  EXPECT_TRUE((*mesh)->closed);
  EXPECT_NEAR((*mesh)->unit_inertial.mass, 8.0 / 6, 1e-12);
}

TEST(MeshMsh, RejectsDamagedFiles) {
  const std::string good = tetrahedron();
  std::string wrong_index = good;
  wrong_index[good.size() - 4] = 4;
  std::string infinite = good;
  infinite.replace(16, 4, std::string("\x00\x00\x80\x7f", 4));
  std::string gigabytes = good;
  gigabytes.replace(12, 4, std::string("\xff\xff\xff\xff", 4));
  for (const std::string& bad :
       {std::string("abc"), good.substr(0, good.size() - 1), good + " ", wrong_index, infinite, gigabytes}) {
    const auto mesh = mesh_from_bytes(bad, MeshFormat::msh, Vec3(1), "t");
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error(), "is not an MSH file of MuJoCo, or is damaged. Export it as binary STL.");
  }
}

}  // namespace
}  // namespace limber::model
