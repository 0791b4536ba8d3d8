// Reads MSH, MuJoCo's binary meshes: four counts (vertices, normals, texture coordinates, faces), then these arrays as
// 32-bit numbers.
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "model/mesh/load.h"
#include "model/mesh/triangles.h"

namespace limber::model {

namespace {

// the 32-bit number at an index of the file; files are little-endian
std::uint32_t word_at(std::string_view bytes, std::uint64_t index) {
  std::uint32_t value = 0;
  for (std::uint64_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[4 * index + i])) << (8 * i);
  return value;
}

}  // namespace

Result<MeshSoup> soup_from_msh(std::string_view bytes) {
  constexpr std::uint64_t kHeader = 4;
  const Error damaged{"is not an MSH file of MuJoCo, or is damaged. Export it as binary STL."};
  if (bytes.size() < 4 * kHeader) return damaged;
  const std::uint64_t vertices = word_at(bytes, 0), normals = word_at(bytes, 1), coordinates = word_at(bytes, 2),
                      faces = word_at(bytes, 3);
  const std::uint64_t first_face = kHeader + 3 * vertices + 3 * normals + 2 * coordinates;
  if (bytes.size() != 4 * (first_face + 3 * faces)) return damaged;
  if (faces > kMaxMeshTriangles) return too_many_triangles();
  MeshSoup soup;
  soup.reserve(3 * faces);
  for (std::uint64_t i = 0; i < 3 * faces; ++i) {
    const std::uint64_t vertex = word_at(bytes, first_face + i);
    if (vertex >= vertices) return damaged;
    Vec3 point;
    for (int k = 0; k < 3; ++k) {
      const auto at = kHeader + 3 * vertex + static_cast<std::uint64_t>(k);
      point[k] = static_cast<double>(std::bit_cast<float>(word_at(bytes, at)));
    }
    if (!is_finite(point)) return damaged;
    soup.push_back(point);
  }
  return soup;
}

}  // namespace limber::model
