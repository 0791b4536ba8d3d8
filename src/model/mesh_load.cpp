// Reads meshes with assimp, which is never given a file, only bytes and the one importer that fits them.
#include "model/mesh_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <unordered_map>
#include <utility>
#include <vector>

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "base/text.h"
#include "model/hull.h"
#include "model/mass_properties.h"
#include "model/mesh_collada.h"
#include "model/shape_recognise.h"
#include "model/urdf_text.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 3> kEndings{"stl", "obj", "dae"};
constexpr int kMostNodes = 100'000;
constexpr double kMostCoordinate = 1e6;

/// Opens nothing: what a mesh file names (materials, pictures) is not read.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

/// Leaves the importer with one reader, so that odd bytes don't wander through fifty others.
void keep_only(Assimp::Importer& importer, std::string_view ending) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* reader = importer.GetImporter(i);
    if (!reader || !reader->GetInfo()) continue;
    const std::string endings = fmt::format(" {} ", reader->GetInfo()->mFileExtensions);
    if (endings.find(fmt::format(" {} ", ending)) != std::string::npos) continue;
    importer.UnregisterLoader(reader);
    delete reader;
  }
}

std::string_view first_line(std::string_view text) { return text.substr(0, text.find('\n')); }

/// The part of an STL file that assimp reads to the end: binary ones cut to the length they say, ASCII ones whole. What
/// is neither, and ASCII that stops in the middle (which assimp takes without a word), is refused.
Result<std::string_view> stl_bytes(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 512);
  const bool seven_bit =
      std::all_of(start.begin(), start.end(), [](char c) { return static_cast<unsigned char>(c) < 127; });
  std::uint32_t count = 0;
  if (bytes.size() >= 84) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::size_t said = 84 + 50 * static_cast<std::size_t>(count);
  const bool ascii = seven_bit && bytes.starts_with("solid") && bytes.find("facet") != std::string_view::npos &&
                     bytes.find("vertex") != std::string_view::npos;
  if (count > 0 && (bytes.size() == said || (bytes.size() > said && !ascii))) return bytes.substr(0, said);
  if (!ascii) {
    return Error{"can't be read: neither ASCII STL nor binary STL as long as it says. Export it again as binary STL."};
  }
  if (bytes.find("endsolid") == std::string_view::npos) {
    return Error{"can't be read: the ASCII STL stops before 'endsolid'. Export it again as binary STL."};
  }
  return bytes;
}

/// Triangles of all nodes, in the frame of the root.
struct Soup {
  std::vector<Vec3> vertices;
  std::vector<unsigned> triangles;
};

Vec3 transformed(const aiMatrix4x4& m, const aiVector3D& v) {
  const double x = v.x, y = v.y, z = v.z;
  return {m.a1 * x + m.a2 * y + m.a3 * z + m.a4, m.b1 * x + m.b2 * y + m.b3 * z + m.b4,
          m.c1 * x + m.c2 * y + m.c3 * z + m.c4};
}

bool add_mesh(const aiMesh& mesh, const aiMatrix4x4& pose, Soup& soup) {
  const auto base = static_cast<unsigned>(soup.vertices.size());
  const aiMatrix3x3 turn(pose);
  const bool flipped = turn.Determinant() < 0;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) soup.vertices.push_back(transformed(pose, mesh.mVertices[i]));
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::array<unsigned, 3> corner{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (std::any_of(corner.begin(), corner.end(), [&](unsigned c) { return c >= mesh.mNumVertices; })) continue;
    if (flipped) std::swap(corner[1], corner[2]);
    for (const unsigned c : corner) soup.triangles.push_back(base + c);
  }
  return soup.triangles.size() / 3 <= kMostMeshTriangles && soup.vertices.size() <= 3 * kMostMeshTriangles;
}

bool walk(const aiScene& scene, Soup& soup) {
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> open{{scene.mRootNode, aiMatrix4x4()}};
  for (int nodes = 0; !open.empty(); ++nodes) {
    const auto [node, above] = open.back();
    open.pop_back();
    if (nodes > kMostNodes) return false;
    const aiMatrix4x4 pose = above * node->mTransformation;
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      const unsigned mesh = node->mMeshes[i];
      if (mesh < scene.mNumMeshes && !add_mesh(*scene.mMeshes[mesh], pose, soup)) return false;
    }
    for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], pose);
  }
  return true;
}

Result<Soup> read_soup(std::string_view bytes, std::string_view ending) {
  Assimp::Importer importer;
  importer.SetIOHandler(new NoFiles);
  keep_only(importer, ending);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                          aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                          aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                          aiComponent_TEXTURES | aiComponent_LIGHTS |
                                                          aiComponent_CAMERAS | aiComponent_MATERIALS);
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_RemoveComponent | aiProcess_JoinIdenticalVertices,
      std::string(ending).c_str());
  if (!scene || !scene->mRootNode) {
    return Error{fmt::format("can't be read: {}. Export it again as binary STL.",
                             printable(first_line(importer.GetErrorString())))};
  }
  Soup soup;
  if (!walk(*scene, soup)) {
    return Error{fmt::format("has more than {} triangles. Simplify it.", kMostMeshTriangles)};
  }
  return soup;
}

struct VertexHash {
  std::size_t operator()(const Vec3& v) const {
    std::size_t h = 0;
    // adding 0 makes -0 and 0 one key
    for (int i = 0; i < 3; ++i) h = h * 1000003u ^ std::hash<double>()(v[i] + 0.0);
    return h;
  }
};

/// Equal vertices become one, triangles without area by index go, unused vertices go.
void weld(const Soup& soup, MeshModel& out) {
  std::unordered_map<Vec3, unsigned, VertexHash> number;
  for (std::size_t i = 0; i + 2 < soup.triangles.size(); i += 3) {
    std::array<unsigned, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& v = soup.vertices[soup.triangles[i + k]];
      const auto [found, is_new] = number.emplace(v, static_cast<unsigned>(out.vertices.size()));
      if (is_new) out.vertices.push_back(v);
      corner[k] = found->second;
    }
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    out.triangles.insert(out.triangles.end(), corner.begin(), corner.end());
  }
}

void flip(std::vector<unsigned>& triangles) {
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) std::swap(triangles[i + 1], triangles[i + 2]);
}

/// Hull, closedness, volume: a closed mesh has its own mass properties, unless they can't be; else its hull's.
void measure(MeshModel& mesh) {
  const Hull whole = convex_hull(mesh.vertices);
  const Hull contact = reduced_hull(whole);
  mesh.hull = contact.vertices;
  mesh.hull_error = contact.error;
  mesh.primitive = recognise(whole);
  const Inertial hull = solid_of(whole.vertices, whole.triangles);
  mesh.closed = is_closed(mesh.triangles);
  Inertial own = mesh.closed ? solid_of(mesh.vertices, mesh.triangles) : Inertial{};
  if (own.mass < 0) {
    flip(mesh.triangles);
    own.mass = -own.mass;
    own.tensor = -own.tensor;
  }
  const bool sound = own.mass > 1e-6 * hull.mass && own.mass <= hull.mass * 1.0001 && tensor_fault(own.tensor).empty();
  mesh.solid = sound ? own : hull;
}

}  // namespace

Result<MeshFormat> mesh_format_of(std::string_view path) {
  std::string ending(path.substr(std::min(path.rfind('.'), path.size())));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (std::size_t i = 0; i < kEndings.size(); ++i) {
    if (ending.size() == 4 && ending.substr(1) == kEndings[i]) return static_cast<MeshFormat>(i);
  }
  return Error{"is no mesh that is read here. Give an STL, OBJ or DAE file."};
}

Result<std::shared_ptr<const MeshModel>> mesh_from_bytes(std::string_view bytes, MeshFormat format, const Vec3& scale,
                                                         const std::string& name) {
  if (bytes.empty()) return Error{"is empty. Export it again."};
  try {
    const Result<std::string> collada = format == MeshFormat::dae ? clean_collada(bytes) : std::string();
    if (!collada) return Error{collada.error()};
    const Result<std::string_view> stl = format == MeshFormat::stl ? stl_bytes(bytes) : bytes;
    if (!stl) return Error{stl.error()};
    bytes = format == MeshFormat::dae ? std::string_view(*collada) : *stl;
    Result<Soup> soup = read_soup(bytes, kEndings[static_cast<std::size_t>(format)]);
    if (!soup) return Error{soup.error()};
    for (Vec3& v : soup->vertices) {
      v *= scale;
      if (is_finite(v) && glm::length(v) <= kMostCoordinate) continue;
      return Error{fmt::format("has a vertex that is not finite or beyond {:g} m. Export it again, or check its scale.",
                               kMostCoordinate)};
    }
    auto mesh = std::make_shared<MeshModel>();
    mesh->name = name;
    weld(*soup, *mesh);
    if (mesh->triangles.empty()) return Error{"holds no triangles. Export it again, as a surface."};
    if (scale.x * scale.y * scale.z < 0) flip(mesh->triangles);
    measure(*mesh);
    if (mesh->hull.size() < 4) return Error{"is too small to have a hull. Check its scale: URDF wants metres."};
    return std::shared_ptr<const MeshModel>(std::move(mesh));
  } catch (const std::exception& e) {
    return Error{fmt::format("can't be read: {}. Export it again as binary STL.", printable(e.what()))};
  }
}

Result<std::shared_ptr<const MeshModel>> load_mesh(const std::string& path, const Vec3& scale) {
  const Result<MeshFormat> format = mesh_format_of(path);
  if (!format) return Error{fmt::format("{}: {}", printable(path), format.error())};
  const Result<std::string> bytes = read_whole_file(path, kMostMeshBytes);
  if (!bytes) return Error{bytes.error()};
  auto mesh = mesh_from_bytes(*bytes, *format, scale, std::filesystem::path(path).stem().string());
  if (!mesh) return Error{fmt::format("{}: {}", printable(path), mesh.error())};
  return mesh;
}

}  // namespace limber
