// Mesh loading: calls the format's reader, then scales and welds the triangles and computes hull and mass properties.
#include "model/mesh/load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/look/soup_look.h"
#include "model/mesh/fit_primitive.h"
#include "model/mesh/hull.h"
#include "model/mesh/mass_properties.h"
#include "model/mesh/triangles.h"
#include "model/pieces/pieces.h"
#include "model/xml_text.h"

namespace limber::model {

namespace {

constexpr std::array<std::string_view, 7> kExtensions{"stl", "obj", "dae", "msh", "ply", "gltf", "glb"};
constexpr double kMaxCoordinate = 1e6;

Result<MeshSoup> read_soup(std::string_view bytes, MeshFormat format, SoupLook& look, SoupObjects& objects) {
  switch (format) {
    case MeshFormat::stl:
      return soup_from_stl(bytes, &look);
    case MeshFormat::obj:
      return soup_from_obj(bytes, &look, &objects);
    case MeshFormat::dae:
      return soup_from_collada(bytes, &look);
    case MeshFormat::msh:
      return soup_from_msh(bytes);
    case MeshFormat::ply:
      return soup_from_ply(bytes, &look);
    case MeshFormat::gltf:
    case MeshFormat::glb:
      return soup_from_gltf(bytes, &look, &objects);
  }
  return Error{"is not a supported mesh format. Use an STL, OBJ, DAE, PLY or glTF file."};
}

struct VertexHash {
  std::size_t operator()(const Vec3& v) const {
    std::size_t h = 0;
    // adding 0 turns -0 into 0, so that both have the same hash
    for (int i = 0; i < 3; ++i) h = h * 1000003u ^ std::hash<double>()(v[i] + 0.0);
    return h;
  }
};

template <class T>
void move_triangle(std::vector<T>& corners, std::size_t from, std::size_t to) {
  if (corners.empty()) return;
  for (std::size_t k = 0; k < 3; ++k) corners[3 * to + k] = corners[3 * from + k];
}

/// Merges equal vertices and drops triangles that then use a vertex twice.
void weld(const MeshSoup& soup, MeshModel& out, MeshLook* look, SoupObjects& objects) {
  std::unordered_map<Vec3, unsigned, VertexHash> number;
  number.reserve(soup.size() / 4);
  out.triangles.reserve(soup.size());
  for (std::size_t i = 0; i + 2 < soup.size(); i += 3) {
    std::array<unsigned, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, is_new] = number.emplace(soup[i + k], static_cast<unsigned>(out.vertices.size()));
      if (is_new) out.vertices.push_back(soup[i + k]);
      corner[k] = found->second;
    }
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    const std::size_t to = out.triangles.size() / 3;
    if (!objects.empty()) objects[to] = objects[i / 3];
    if (look != nullptr) {
      if (!look->triangle_materials.empty()) look->triangle_materials[to] = look->triangle_materials[i / 3];
      move_triangle(look->texcoords, i / 3, to);
      move_triangle(look->colors, i / 3, to);
    }
    out.triangles.insert(out.triangles.end(), corner.begin(), corner.end());
  }
  if (!objects.empty()) objects.resize(out.triangles.size() / 3);
  if (look == nullptr) return;
  if (!look->triangle_materials.empty()) look->triangle_materials.resize(out.triangles.size() / 3);
  if (!look->texcoords.empty()) look->texcoords.resize(out.triangles.size());
  if (!look->colors.empty()) look->colors.resize(out.triangles.size());
}

template <class T>
void flip_corners(std::vector<T>& corners) {
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) std::swap(corners[i + 1], corners[i + 2]);
}

void flip_winding(MeshModel& mesh, MeshLook* look) {
  flip_corners(mesh.triangles);
  if (look == nullptr) return;
  flip_corners(look->texcoords);
  flip_corners(look->colors);
}

/// Computes hulls, the matching primitive, pieces, closedness and mass properties. A closed mesh uses its own volume if
/// that is plausible; other meshes use that of their hull, or those of their objects.
void compute_properties(MeshModel& mesh, MeshLook* look, const SoupObjects& objects) {
  const Hull complete = convex_hull(mesh.vertices);
  const Hull contact = reduced_hull(complete);
  mesh.hull = contact.vertices;
  mesh.hull_error = contact.error;
  mesh.primitive = recognize_primitive(complete);
  const Inertial hull = unit_inertial_of(complete.vertices, complete.triangles);
  mesh.hull_volume = hull.mass;
  const ObjectSolids solids = split_objects(mesh, objects);
  mesh.closed = is_closed(mesh.triangles) || solids.watertight;
  Inertial own = mesh.closed ? unit_inertial_of(mesh.vertices, mesh.triangles) : Inertial{};
  if (own.mass < 0) {
    flip_winding(mesh, look);
    own.mass = -own.mass;
    own.tensor = -own.tensor;
  }
  const bool plausible =
      own.mass > 1e-6 * hull.mass && own.mass <= hull.mass * 1.0001 && tensor_error(own.tensor).empty();
  mesh.unit_inertial = plausible ? own : mesh.pieces.empty() ? hull : solids.inertial;
}

}  // namespace

Result<MeshFormat> mesh_format_of(std::string_view path) {
  std::string extension(path.substr(std::min(path.rfind('.'), path.size())));
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (std::size_t i = 0; i < kExtensions.size(); ++i) {
    if (extension.size() > 1 && extension.substr(1) == kExtensions[i]) return static_cast<MeshFormat>(i);
  }
  return Error{"is not a supported mesh format. Use an STL, OBJ, DAE, PLY or glTF file."};
}

Result<std::shared_ptr<const MeshModel>> mesh_from_bytes(std::string_view bytes, MeshFormat format, const Vec3& scale,
                                                         const std::string& name, LookFiles* files) {
  if (bytes.empty()) return Error{"is empty. Export it again."};
  try {
    SoupLook soup_look(files);
    SoupObjects objects;
    Result<MeshSoup> soup = read_soup(bytes, format, soup_look, objects);
    if (!soup) return Error{soup.error()};
    for (Vec3& v : *soup) {
      v *= scale;
      if (is_finite(v) && glm::length(v) <= kMaxCoordinate) continue;
      return Error{fmt::format("has a vertex that is not finite or beyond {:g} m. Export it again, or check its scale.",
                               kMaxCoordinate)};
    }
    auto mesh = std::make_shared<MeshModel>();
    mesh->name = name;
    mesh->content_hash = hash_bytes(bytes);
    const std::shared_ptr<MeshLook> look = soup_look.release(soup->size());
    mesh->look = look;
    weld(*soup, *mesh, look.get(), objects);
    if (mesh->triangles.empty()) return Error{"contains no triangles. Export it again, as a surface."};
    if (scale.x * scale.y * scale.z < 0) flip_winding(*mesh, look.get());
    compute_properties(*mesh, look.get(), objects);
    if (mesh->hull.size() < 4) return Error{"is too small to have a hull. Check its scale: URDF uses meters."};
    return std::shared_ptr<const MeshModel>(std::move(mesh));
  } catch (const std::exception& e) {
    return Error{fmt::format("can't be read: {}. Export it again as binary STL.", printable(e.what()))};
  }
}

Result<std::shared_ptr<const MeshModel>> load_mesh(const std::string& path, const Vec3& scale, LookFiles* files) {
  const Result<MeshFormat> format = mesh_format_of(path);
  if (!format) return Error{fmt::format("{}: {}", printable(path), format.error())};
  const Result<std::string> bytes = read_whole_file(path, kMaxMeshBytes);
  if (!bytes) return Error{bytes.error()};
  auto mesh = mesh_from_bytes(*bytes, *format, scale, std::filesystem::path(path).stem().string(), files);
  if (!mesh) return Error{fmt::format("{}: {}", printable(path), mesh.error())};
  return mesh;
}

}  // namespace limber::model
