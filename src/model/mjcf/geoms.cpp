// Geoms: shape, mass, contact masks, color.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mjcf/file_reader.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxGeomsOfBody = 1000;
constexpr double kMaxLength = 1e4;
constexpr double kMaxGeomMass = 1e7;

unsigned mask_of(double value) { return value >= 0 && value < 4294967296.0 ? static_cast<unsigned>(value) : 0; }

/// The number of sizes that a geom type has.
std::size_t size_count(std::string_view type) {
  return type == "sphere" ? 1 : type == "capsule" || type == "cylinder" ? 2 : 3;
}

void set_pose(MjcfGeom& geom, const Pose& pose) {
  geom.shape.origin.xyz = pose.position;
  geom.shape.origin.quat = glm::normalize(pose.rotation);
}

}  // namespace

void MjcfFileReader::read_geom(const MjcfElement& element, MjcfBody& body, MjcfClass inherited, const Pose& frame) {
  reader_.check_attributes(element);
  if (body.geoms.size() >= kMaxGeomsOfBody) {
    reader_.unsupported(element, fmt::format("a body has more than {} geoms; the rest is ignored", kMaxGeomsOfBody),
                        "Merge them into one mesh.", Severity::error);
    return;
  }
  const MjcfClass cls = reader_.class_of(element, inherited);
  MjcfGeom geom;
  geom.shape.line = reader_.line_of(element);
  set_pose(geom, frame * reader_.pose(element, cls));
  if (!read_shape(element, cls, frame, geom)) return;
  geom.contact_type = mask_of(reader_.number(element, cls, "contype", 1));
  geom.contact_affinity = mask_of(reader_.number(element, cls, "conaffinity", 1));
  geom.group = static_cast<int>(std::clamp(reader_.number(element, cls, "group", 0), 0.0, 1000.0));
  if (const auto mass = reader_.numbers(element, cls, "mass", 1, 1); !mass.empty())
    geom.mass = std::clamp(mass[0], 0.0, kMaxGeomMass);
  geom.density = std::clamp(reader_.number(element, cls, "density", 1000), 0.0, 1e9);
  if (const std::optional<bool> shell = reader_.flag(element, cls, "shellinertia"); shell && *shell) {
    reader_.unsupported(element, "<geom shellinertia> ignored: the geom has the mass of a solid",
                        "Write an <inertial> for its body.", Severity::warning);
  }
  read_color(element, cls, geom);
  body.geoms.push_back(std::move(geom));
}

bool MjcfFileReader::read_shape(const MjcfElement& element, MjcfClass cls, const Pose& frame, MjcfGeom& geom) {
  const std::string* const written = reader_.text(element, cls, "type");
  const std::string* const mesh = reader_.text(element, cls, "mesh");
  const std::string_view type = written != nullptr ? std::string_view(*written) : "sphere";
  if (type == "mesh" || (mesh != nullptr && type != "sdf" && type != "hfield")) {
    if (mesh == nullptr) {
      reader_.error(element, fmt::format("{} names no mesh; ignored", reader_.shown(element)), "Write mesh=\"…\".");
      return false;
    }
    if (type != "mesh") {
      reader_.unsupported(element, "<geom mesh> of another type: the mesh itself is used instead of a fitted shape",
                          "Write type=\"mesh\", or the sizes of the shape.");
    }
    return set_mesh(element, *mesh, geom);
  }
  if (type == "hfield") return heightfields_.apply(reader_, element, reader_.text(element, cls, "hfield"), geom);
  constexpr std::array<std::string_view, 6> kTypes{"sphere", "capsule", "cylinder", "box", "ellipsoid", "plane"};
  if (std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end()) {
    reader_.unsupported(element,
                        type == "sdf" ? fmt::format("<geom type='{}'> ignored: nothing collides with it", type)
                                      : fmt::format("'{}' is not a geom type; ignored", printable_excerpt(type)),
                        "Use plane, sphere, capsule, cylinder, box, ellipsoid, mesh or hfield.", Severity::error);
    return false;
  }
  if (type == "plane") {
    geom.shape.shape.kind = ShapeKind::plane;
    return true;
  }
  return read_size(element, cls, type, frame, geom);
}

bool MjcfFileReader::read_from_to(const MjcfElement& element, MjcfClass cls, std::string_view type, const Pose& frame,
                                  MjcfGeom& geom) {
  const std::vector<double> ends = reader_.numbers(element, cls, "fromto", 6, 6);
  if (ends.empty() || type == "sphere") return false;
  const Vec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
  const Vec3 axis = normalized(to - from);
  const Vec3 turn = glm::cross(Vec3(0, 0, 1), axis);
  const double sine = glm::length(turn);
  Pose pose{0.5 * (from + to), quat_identity()};
  if (sine > 1e-12) {
    pose.rotation = quat_axis(turn / sine, fixed::atan2(sine, axis.z));
  } else if (axis.z < 0) {
    pose.rotation = quat_xyzw(1, 0, 0, 0);
  }
  set_pose(geom, frame * pose);
  geom.shape.shape.height = glm::length(to - from);
  return true;
}

bool MjcfFileReader::read_size(const MjcfElement& element, MjcfClass cls, std::string_view type, const Pose& frame,
                               MjcfGeom& geom) {
  std::vector<double> size = reader_.numbers(element, cls, "size", 1, 3);
  const std::size_t count = size_count(type);
  if (read_from_to(element, cls, type, frame, geom) && !size.empty()) {
    // the length replaces the last size; a box or ellipsoid has equal sizes across
    const double half = geom.shape.shape.height / 2;
    size = count == 2 ? std::vector<double>{size[0], half} : std::vector<double>{size[0], size[0], half};
  }
  if (size.size() < count) {
    reader_.error(
        element,
        fmt::format("{}: size has {} numbers, a {} has {}; ignored", reader_.shown(element), size.size(), type, count),
        "Write size=\"…\" in meters: radius, half length, or half edges.");
    return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (size[i] > 0 && size[i] <= kMaxLength) continue;
    reader_.error(
        element,
        fmt::format("{}: size {:g} is not above 0 and at most 10000 m; ignored", reader_.shown(element), size[i]),
        "Write sizes in meters.");
    return false;
  }
  ShapeModel& shape = geom.shape.shape;
  if (type == "box" || type == "ellipsoid") {
    shape.kind = type == "box" ? ShapeKind::box : ShapeKind::ellipsoid;
    shape.size = 2.0 * Vec3(size[0], size[1], size[2]);
    return true;
  }
  shape.kind = type == "sphere" ? ShapeKind::sphere : type == "capsule" ? ShapeKind::capsule : ShapeKind::cylinder;
  shape.radius = size[0];
  if (count == 2) shape.height = 2 * size[1];
  return true;
}

bool MjcfFileReader::set_mesh(const MjcfElement& element, const std::string& mesh, MjcfGeom& geom) {
  const auto found = meshes_.find(mesh);
  if (found == meshes_.end()) {
    if (!reader_.can_report()) return false;
    std::vector<std::string> names;
    for (const auto& [name, asset] : meshes_) {
      if (names.size() < 200) names.push_back(name);
    }
    reader_.error(element,
                  fmt::format("{}: mesh '{}' does not exist{}; ignored", reader_.shown(element),
                              printable_excerpt(mesh), name_hint(mesh, names)),
                  "Write the name of a <mesh> in <asset>.");
    return false;
  }
  const MeshAsset& asset = found->second;
  if (asset.uri.empty() && asset.mesh == nullptr) return false;  // reported with the asset
  geom.shape.shape.kind = ShapeKind::mesh;
  geom.shape.shape.mesh = asset.mesh;
  geom.shape.mesh_uri = asset.uri;
  geom.shape.mesh_scale = asset.scale;
  set_pose(geom, geom.shape.origin.pose() * asset.reference);
  return true;
}

void MjcfFileReader::read_color(const MjcfElement& element, MjcfClass cls, MjcfGeom& geom) {
  if (const std::string* const name = reader_.text(element, cls, "material")) {
    const auto found = materials_.find(*name);
    if (found != materials_.end()) {
      geom.shape.material.color = found->second.color;
      geom.shape.material.alpha = found->second.alpha;
      const auto texture = textures_.find(found->second.texture);
      if (texture != textures_.end()) geom.shape.material.texture_uri = texture->second;
    } else {
      reader_.unsupported(
          element, fmt::format("material '{}' is not defined; the default color is used", printable_excerpt(*name)),
          "Write <material name=\"…\" rgba=\"…\"/> in <asset>.", Severity::warning);
    }
  }
  if (const auto rgba = reader_.numbers(element, cls, "rgba", 4, 4); !rgba.empty()) {
    geom.shape.material.color =
        Vec3(std::clamp(rgba[0], 0.0, 1.0), std::clamp(rgba[1], 0.0, 1.0), std::clamp(rgba[2], 0.0, 1.0));
    geom.shape.material.alpha = std::clamp(rgba[3], 0.0, 1.0);
  }
}

}  // namespace limber::model
