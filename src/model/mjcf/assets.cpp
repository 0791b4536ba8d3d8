// Assets: meshes and materials.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/mesh/hull.h"
#include "model/mesh/load.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxInlineNumbers = 300'000;
constexpr std::size_t kMaxAssets = 10'000;
constexpr double kMaxScale = 1e6;

bool is_valid_scale(const Vec3& scale) {
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(scale[i]) >= 1e-9 && std::abs(scale[i]) <= kMaxScale)) return false;
  }
  return true;
}

/// A mesh of points; of the triangles of `faces` (three indices each), or of the convex hull if there are none.
Result<std::shared_ptr<const MeshModel>> mesh_of_points(std::span<const Vec3> points, std::span<const unsigned> faces,
                                                        const std::string& name) {
  std::vector<Vec3> vertices(points.begin(), points.end());
  std::vector<unsigned> triangles(faces.begin(), faces.end());
  if (triangles.empty()) {
    Hull hull = convex_hull(points);
    vertices = std::move(hull.vertices);
    triangles = std::move(hull.triangles);
  }
  // as the text of an OBJ file, so that the mesh gets the checks and results of every other mesh
  std::string text;
  for (const Vec3& v : vertices) fmt::format_to(std::back_inserter(text), "v {:.17g} {:.17g} {:.17g}\n", v.x, v.y, v.z);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", triangles[i] + 1, triangles[i + 1] + 1,
                   triangles[i + 2] + 1);
  }
  return mesh_from_bytes(text, MeshFormat::obj, Vec3(1), name);
}

}  // namespace

std::string mjcf_asset_path(const MjcfCompiler& compiler, const std::string& folder, const std::string& file) {
  const std::filesystem::path path(file);
  const std::filesystem::path inner = compiler.strip_path ? path.filename() : path;
  return (std::filesystem::path(folder) / inner).lexically_normal().string();
}

void MjcfFileReader::read_assets(const MjcfElement& element) {
  for (const MjcfElement& e : element.children) {
    if (meshes_.size() + heightfields_.size() + materials_.size() + textures_.size() > kMaxAssets) return;
    if (e.name == "mesh") {
      read_mesh(e);
    } else if (e.name == "material") {
      read_material(e);
    } else if (e.name == "hfield") {
      heightfields_.read(reader_, e);
    } else if (e.name == "texture") {
      read_texture(e);
    } else {
      constexpr std::array<std::string_view, 6> kAssets{"mesh", "material", "texture", "hfield", "skin", "model"};
      reader_.unknown(e, fmt::format("<{}> in <asset> ignored: it is not supported", printable_excerpt(e.name)),
                      kAssets, "Use <mesh>, <hfield> and <material>.");
    }
  }
}

void MjcfFileReader::read_mesh(const MjcfElement& element) {
  reader_.check_attributes(element);
  const MjcfClass cls = reader_.class_of(element, 0);
  MeshAsset asset;
  asset.element = &element;
  std::string name = reader_.name(element);
  asset.scale = reader_.vector(element, cls, "scale").value_or(Vec3(1));
  if (!is_valid_scale(asset.scale)) {
    reader_.error(element, fmt::format("{}: a scale is 0 or above 1e6; using 1", reader_.shown(element)),
                  "Write three factors, such as scale=\"0.001 0.001 0.001\" for millimeters.");
    asset.scale = Vec3(1);
  }
  Quat reference = quat_identity();
  if (const auto q = reader_.numbers(element, cls, "refquat", 4, 4); !q.empty()) {
    const Quat read = quat_xyzw(q[1], q[2], q[3], q[0]);
    if (glm::length(read) > 1e-9) reference = glm::normalize(read);
  }
  // vertices are moved by -refpos, rotated by the inverse of refquat, then scaled
  const Quat inverse = glm::conjugate(reference);
  const Vec3 offset = reader_.vector(element, cls, "refpos").value_or(Vec3(0));
  asset.reference = {asset.scale * (inverse * -offset), inverse};
  const bool uniform = asset.scale.x == asset.scale.y && asset.scale.y == asset.scale.z;
  if (!uniform && !nearly_same(reference, quat_identity())) {
    reader_.warning(element,
                    fmt::format("{}: scale is applied before refquat; the mesh is distorted", reader_.shown(element)),
                    "Use the same factor for all axes.");
  }
  if (const std::string* file = reader_.text(element, cls, "file")) {
    if (name.empty()) name = std::filesystem::path(*file).stem().string();
    asset.uri = mjcf_asset_path(reader_.compiler, reader_.compiler.mesh_folder, *file);
  } else {
    read_inline_mesh(element, cls, asset);
  }
  if (!meshes_.try_emplace(name, asset).second) {
    reader_.error(element, fmt::format("mesh '{}' is declared twice; using the first", printable_excerpt(name)),
                  "Give every mesh a name of its own.");
  }
}

void MjcfFileReader::read_inline_mesh(const MjcfElement& element, MjcfClass cls, MeshAsset& asset) {
  const std::vector<double> numbers = reader_.numbers(element, cls, "vertex", 12, kMaxInlineNumbers);
  const std::vector<double> corners = reader_.numbers(element, cls, "face", 3, kMaxInlineNumbers);
  std::vector<Vec3> points;
  std::vector<unsigned> faces;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    points.push_back(asset.scale * Vec3(numbers[i], numbers[i + 1], numbers[i + 2]));
  for (const double corner : corners) {
    if (corner >= 0 && corner < static_cast<double>(points.size())) faces.push_back(static_cast<unsigned>(corner));
  }
  const bool valid = numbers.size() % 3 == 0 && faces.size() == corners.size() && faces.size() % 3 == 0;
  const auto mesh = valid && !points.empty()
                        ? mesh_of_points(points, faces, "mesh")
                        : Result<std::shared_ptr<const MeshModel>>(Error{"it has no valid vertices"});
  if (mesh) {
    asset.mesh = *mesh;
    return;
  }
  reader_.error(element, fmt::format("{} ignored: {}", reader_.shown(element), mesh.error()),
                "Write file=\"…\", or vertex=\"…\" with at least four points.");
}

void MjcfFileReader::read_material(const MjcfElement& element) {
  reader_.check_attributes(element);
  const MjcfClass cls = reader_.class_of(element, 0);
  const std::string name = reader_.name(element);
  Material material;
  if (const auto rgba = reader_.numbers(element, cls, "rgba", 4, 4); !rgba.empty()) {
    material.color = Vec3(std::clamp(rgba[0], 0.0, 1.0), std::clamp(rgba[1], 0.0, 1.0), std::clamp(rgba[2], 0.0, 1.0));
    material.alpha = std::clamp(rgba[3], 0.0, 1.0);
  }
  if (const std::string* const texture = reader_.text(element, cls, "texture")) material.texture = *texture;
  materials_.try_emplace(name, material);
}

void MjcfFileReader::read_texture(const MjcfElement& element) {
  const std::string* const file = element.attribute("file");
  const bool sky = element.attribute("type") != nullptr && *element.attribute("type") == "skybox";
  if (file == nullptr) {
    reader_.unsupported(element,
                        sky ? "<texture type='skybox'> ignored: the scene sets the background"
                            : "<texture> without a file ignored: its shapes have plain colors",
                        sky ? "Set visuals.look in the scene." : "Write rgba for the material.");
    return;
  }
  std::string name = reader_.name(element);
  if (name.empty()) name = std::filesystem::path(*file).stem().string();
  textures_.try_emplace(name, mjcf_asset_path(reader_.compiler, reader_.compiler.texture_folder, *file));
}

}  // namespace limber::model
