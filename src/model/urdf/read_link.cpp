// Links of a URDF: inertial, visuals, collisions, geometries.
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/text.h"
#include "model/urdf/reader.h"

namespace limber::model {

namespace {

constexpr std::size_t kMaxShapes = 1000;
constexpr NumberRange kMassRange{0, 1e7, "from 0 to 1e7 kg"};
constexpr NumberRange kTensorRange{-1e12, 1e12, "within 1e12 kg·m²"};
constexpr NumberRange kScaleRange{-1e6, 1e6, "within 1e6, not 0"};
constexpr NumberRange kNormalRange{-1e6, 1e6, "within 1e6"};

// PyBullet's attribute of links, collisions and geometries
bool is_concave(const tinyxml2::XMLElement& element) {
  const char* const text = element.Attribute("concave");
  return text != nullptr && !same_name(text, "no") && !same_name(text, "false") && !same_name(text, "0");
}

}  // namespace

UrdfLink UrdfReader::link(const Element& element, const std::string& name) {
  UrdfLink out;
  out.name = name;
  out.line = element.GetLineNum();
  const std::string owner = fmt::format("link '{}'", printable(name));
  check_attributes(element, {"name"});
  const bool concave = is_concave(element);
  if (const Element* found = unique_child(element, "inertial", owner)) out.inertial = inertial(*found, owner);
  for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string_view kind = name_of(*e);
    if (kind != "visual" && kind != "collision") continue;
    std::vector<UrdfShape>& to = kind == "visual" ? out.visuals : out.collisions;
    if (to.size() >= kMaxShapes) {
      problems.error(e->GetLineNum(),
                     fmt::format("{} has more than {} <{}> elements; the rest is ignored", owner, kMaxShapes, kind),
                     "Merge them into one mesh.");
      break;
    }
    std::optional<UrdfShape> read = shape(*e, owner);
    if (!read) continue;
    if (concave && kind == "collision") read->concave = true;
    to.push_back(std::move(*read));
  }
  return out;
}

std::optional<UrdfInertial> UrdfReader::inertial(const Element& element, const std::string& owner) {
  UrdfInertial out;
  const Element* mass = unique_child(element, "mass", owner);
  if (!mass || !mass->Attribute("value")) {
    problems.error((mass ? mass : &element)->GetLineNum(), fmt::format("{}: <inertial> has no mass; ignored", owner),
                   "Write <mass value=\"…\"/> in kg inside <inertial>.");
    return std::nullopt;
  }
  check_attributes(*mass, {"value"});
  const std::optional<double> value = number(*mass, "value", owner, kMassRange);
  if (!value) return std::nullopt;
  out.mass = *value;
  out.origin = origin(element, owner);
  if (const Element* found = unique_child(element, "inertia", owner)) {
    tensor(*found, owner, out);
  } else if (out.mass > 0) {
    problems.warning(element.GetLineNum(), fmt::format("{}: <inertial> has no <inertia>; using the shape's", owner),
                     "Write <inertia ixx= ixy= ixz= iyy= iyz= izz=/> in kg·m².");
  }
  return out;
}

void UrdfReader::tensor(const Element& element, const std::string& owner, UrdfInertial& out) {
  constexpr const char* kNames[6] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
  constexpr bool kDiagonal[6] = {true, false, false, true, false, true};
  check_attributes(element, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"});
  double parts[6] = {};
  bool good = true;
  for (int i = 0; i < 6; ++i) {
    const std::optional<double> value = number(element, kNames[i], owner, kTensorRange);
    if (value) {
      parts[i] = *value;
    } else if (!element.Attribute(kNames[i]) && !kDiagonal[i]) {
      problems.note(element.GetLineNum(), fmt::format("{}: <inertia> has no {}; taken as 0", owner, kNames[i]),
                    fmt::format("Write {}=\"0\".", kNames[i]));
    } else {
      good = false;
    }
  }
  if (!good) {
    problems.error(element.GetLineNum(), fmt::format("{}: <inertia> is incomplete; using the shape's tensor", owner),
                   "Write all six: ixx ixy ixz iyy iyz izz, in kg·m².");
    return;
  }
  out.has_tensor = true;
  out.tensor = Mat3(parts[0], parts[1], parts[2], parts[1], parts[3], parts[4], parts[2], parts[4], parts[5]);
}

std::optional<UrdfShape> UrdfReader::shape(const Element& element, const std::string& owner) {
  UrdfShape out;
  out.line = element.GetLineNum();
  check_attributes(element, {"name"});
  out.origin = origin(element, owner);
  const Element* geometry_element = unique_child(element, "geometry", owner);
  const Element* kind = geometry_element ? geometry_element->FirstChildElement() : nullptr;
  if (!kind) {
    problems.error(element.GetLineNum(), fmt::format("{}: a <{}> has no geometry; ignored", owner, name_of(element)),
                   "Write <geometry> with one <box>, <sphere>, <cylinder>, <capsule> or <mesh> inside.");
    return std::nullopt;
  }
  if (kind->NextSiblingElement()) {
    problems.warning(kind->NextSiblingElement()->GetLineNum(),
                     fmt::format("{}: a <geometry> contains more than one shape; using the first", owner),
                     fmt::format("Write one <{}> for each shape.", name_of(element)));
  }
  if (!geometry(*kind, owner, out)) return std::nullopt;
  out.concave = is_concave(element) || is_concave(*kind);
  if (const Element* element_of_material = child(element, "material")) {
    check_attributes(*element_of_material, {"name"});
    if (const char* name = element_of_material->Attribute("name")) out.material_name = name;
    material(*element_of_material, owner, out.material);
  }
  return out;
}

bool UrdfReader::read_length(const Element& element, const char* attribute, const std::string& owner, double& out) {
  if (!element.Attribute(attribute)) {
    problems.error(element.GetLineNum(), fmt::format("{}: <{}> has no {}; ignored", owner, name_of(element), attribute),
                   fmt::format("Write {}=\"…\" in meters.", attribute));
    return false;
  }
  const std::optional<double> value = number(element, attribute, owner, kLengthRange);
  out = value.value_or(0);
  return value.has_value();
}

bool UrdfReader::geometry(const Element& element, const std::string& owner, UrdfShape& out) {
  const std::string_view kind = name_of(element);
  ShapeModel& shape = out.shape;
  if (kind == "mesh") return mesh_geometry(element, owner, out);
  if (kind == "sphere") {
    check_attributes(element, {"radius"});
    shape.kind = ShapeKind::sphere;
    return read_length(element, "radius", owner, shape.radius);
  }
  if (kind == "cylinder" || kind == "capsule") {
    check_attributes(element, {"radius", "length"});
    shape.kind = kind == "cylinder" ? ShapeKind::cylinder : ShapeKind::capsule;
    return read_length(element, "radius", owner, shape.radius) && read_length(element, "length", owner, shape.height);
  }
  if (kind == "box") {
    check_attributes(element, {"size"});
    shape.kind = ShapeKind::box;
    if (!element.Attribute("size")) {
      problems.error(element.GetLineNum(), fmt::format("{}: <box> has no size; ignored", owner),
                     "Write size=\"x y z\" in meters.");
      return false;
    }
    const std::optional<Vec3> size = vector(element, "size", owner, kLengthRange);
    if (size) shape.size = *size;
    return size.has_value();
  }
  if (kind == "plane") {
    check_attributes(element, {"normal"});
    shape.kind = ShapeKind::plane;
    const Vec3 normal = normalized(vector(element, "normal", owner, kNormalRange).value_or(Vec3(0, 0, 1)));
    shape.normal = glm::length(normal) > 0.5 ? normal : Vec3(0, 0, 1);
    return true;
  }
  problems.error(element.GetLineNum(),
                 fmt::format("{}: geometry <{}> is not supported; ignored", owner, printable(kind)),
                 "Use box, sphere, cylinder, capsule, mesh, or a plane in a link that does not move.");
  return false;
}

bool UrdfReader::mesh_geometry(const Element& element, const std::string& owner, UrdfShape& out) {
  out.shape.kind = ShapeKind::mesh;
  check_attributes(element, {"filename", "scale"});
  const char* file = element.Attribute("filename");
  if (!file || !*file) {
    problems.error(element.GetLineNum(), fmt::format("{}: <mesh> names no file; ignored", owner),
                   "Write filename=\"…\" with the path of an STL, OBJ, DAE, PLY or glTF file.");
    return false;
  }
  out.mesh_uri = file;
  if (!element.Attribute("scale")) return true;
  const std::optional<Vec3> scale = vector(element, "scale", owner, kScaleRange);
  if (!scale) return false;
  out.mesh_scale = *scale;
  if (std::abs(scale->x) >= 1e-9 && std::abs(scale->y) >= 1e-9 && std::abs(scale->z) >= 1e-9) return true;
  problems.error(element.GetLineNum(), fmt::format("{}: <mesh> has a scale of 0; ignored", owner),
                 "Write three factors other than 0, such as scale=\"0.001 0.001 0.001\" for millimeters.");
  return false;
}

}  // namespace limber::model
