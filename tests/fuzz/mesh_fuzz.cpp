// Fuzzes the mesh readers. Input: the first byte selects the format and the scale, the rest is the file.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/target.h"
#include "model/look/mesh_look.h"
#include "model/mesh/load.h"
#include "model/pieces/decompose.h"
#include "model/pieces/pieces.h"

namespace {

void check_pieces(const limber::model::MeshModel& mesh) {
  limber::must(mesh.pieces.size() <= limber::model::kMaxPieces && std::isfinite(mesh.hull_volume));
  for (const limber::model::PlacedShape& piece : mesh.pieces) {
    limber::must(limber::is_finite(piece.origin.position));
    if (piece.shape.kind != limber::model::ShapeKind::mesh) continue;
    limber::must(piece.shape.mesh->hull.size() >= 4 && piece.shape.mesh->hull.size() <= 64);
    for (const limber::Vec3& v : piece.shape.mesh->hull) limber::must(limber::is_finite(v));
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array kFormats{limber::model::MeshFormat::stl, limber::model::MeshFormat::obj,
                                limber::model::MeshFormat::dae};
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const limber::Vec3 scale = data[0] % 2 == 0 ? limber::Vec3(1) : limber::Vec3(0.5, -2, 3);
  using limber::model::MeshFormat;
  const auto format = data[0] >= 200   ? MeshFormat::msh
                      : data[0] >= 190 ? MeshFormat::ply
                      : data[0] >= 180 ? MeshFormat::gltf
                                       : kFormats[data[0] / 2 % 3];
  const auto mesh = limber::model::mesh_from_bytes(bytes, format, scale, "fuzz");
  if (!mesh) {
    limber::must(!mesh.error().empty());
    return 0;
  }
  const limber::model::MeshModel& m = **mesh;
  for (const limber::Vec3& v : m.vertices) limber::must(limber::is_finite(v));
  for (const unsigned t : m.triangles) limber::must(t < m.vertices.size());
  limber::must(m.triangles.size() % 3 == 0 && m.hull.size() >= 4 && m.hull.size() <= 64);
  check_pieces(m);
  if (m.triangles.size() <= 3000) check_pieces(*limber::model::decomposed(*mesh));
  limber::must(std::isfinite(m.hull_error) && m.unit_inertial.mass > 0 && std::isfinite(m.unit_inertial.mass));
  if (m.look == nullptr) return 0;
  const std::size_t corners = m.triangles.size();
  limber::must(m.look->texcoords.empty() || m.look->texcoords.size() == corners);
  limber::must(m.look->colors.empty() || m.look->colors.size() == corners);
  limber::must(m.look->materials.empty() || m.look->triangle_materials.size() == corners / 3);
  for (const std::uint32_t material : m.look->triangle_materials) limber::must(material < m.look->materials.size());
  return 0;
}
