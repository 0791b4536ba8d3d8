// Shape: validation, compounds, geometry.
#include "sim/shapes/shape.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/color.h"
#include "model/mesh/surface.h"
#include "sim/shapes/geometry.h"

namespace limber::sim {

const PropertyTable& Shape::table() {
  using namespace properties;
  static const PropertyTable table(
      "shape", "/visuals/shape/<shape>", "/visuals/shape",
      {
          number("transparency", "", 0, 0, 1, "0: opaque; 1: invisible."),
          number("ambient_scale", "", 0.5, 0, 10, "Factor on the ambient light."),
          number("diffuse_scale", "", 0.5, 0, 10, "Factor on the lamps' light."),
          number("specular_scale", "", 0.5, 0, 10, "Brightness of highlights."),
          number("specular_pow", "", 10, 0, 1000, "Shininess: the higher, the smaller the highlights."),
          vec3("ambient_color", "hsb", {0, 0, 1}, 0, 1,
               "Color in ambient light: hue, saturation, brightness; the default is diffuse_color."),
          vec3("diffuse_color", "hsb", {0, 0, 1}, 0, 1, "Color in the lamps' light: hue, saturation, brightness."),
          state(computed<&Shape::read_color, &Shape::write_color>(
              vec3("color", "hsb", {0, 0, 1}, 0, 1, "Sets ambient_color and diffuse_color; reads diffuse_color."))),
      });
  return table;
}

namespace {

constexpr const char* kColors[] = {"ambient_color", "diffuse_color"};
constexpr double kMinLength = 1e-4;
constexpr double kMaxLength = 1e4;

Result<void> check_length(double value, std::string_view shape, std::string_view dimension) {
  if (value >= kMinLength && value <= kMaxLength) return {};
  const char* const article = shape.front() == 'e' ? "an" : "a";
  return Error{
      fmt::format("{} {} needs a {} of {} .. {} m, not {}", article, shape, dimension, kMinLength, kMaxLength, value)};
}

Result<void> check_lengths(const Vec3& values, std::string_view shape, std::string_view dimension) {
  for (int i = 0; i < 3; i++) {
    if (const Result<void> ok = check_length(values[i], shape, dimension); !ok) return ok;
  }
  return {};
}

Result<void> check_mesh(const model::ShapeModel& m) {
  if (m.surface != nullptr) return m.surface->size() > 0 ? Result<void>() : Error{"its triangles have no area"};
  if (m.mesh == nullptr || m.mesh->hull.size() < 4) return Error{"a convex mesh needs at least 4 points"};
  return {};
}

Result<void> first_error(Result<void> a, Result<void> b) { return a ? b : a; }

}  // namespace

std::string visual_shape_name(const model::BodyModel& model, const model::LinkModel& link, std::size_t number) {
  std::string name = fmt::format("{}.{}", model.name, link.name);
  if (number > 0) name += fmt::format(".{}", number + 1);
  return name;
}

Result<void> check_shape(const model::ShapeModel& m) {
  switch (m.kind) {
    case model::ShapeKind::plane:
      if (!is_finite(m.normal) || glm::length(m.normal) < 1e-9) return Error{"a plane needs a normal that is not zero"};
      return {};
    case model::ShapeKind::sphere:
      return check_length(m.radius, "sphere", "radius");
    case model::ShapeKind::box:
      return check_lengths(m.size, "box", "size");
    case model::ShapeKind::ellipsoid:
      return check_lengths(m.size / 2.0, "ellipsoid", "radius");
    case model::ShapeKind::cylinder:
      return first_error(check_length(m.radius, "cylinder", "radius"), check_length(m.height, "cylinder", "height"));
    case model::ShapeKind::capsule:
      return first_error(check_length(m.radius, "capsule", "radius"), check_length(m.height, "capsule", "height"));
    case model::ShapeKind::cone:
      return first_error(check_length(m.radius, "cone", "radius"), check_length(m.height, "cone", "height"));
    case model::ShapeKind::mesh:
      return check_mesh(m);
    case model::ShapeKind::compound:
      return {};
  }
  return {};
}

Shape::Shape(Store& store, NodeId group, std::string name, model::ShapeModel model)
    : store_(store), id_(store.add(table(), group, std::move(name), this)), model_(std::move(model)) {
  if (model_.kind == model::ShapeKind::plane) model_.normal = normalized(model_.normal);
}

void Shape::read_color(double* out) const { std::copy_n(store_.values(id_, table().at("diffuse_color")), 3, out); }

void Shape::write_color(const double* in) {
  for (const char* const property : kColors) (void)store_.set(id_, table().at(property), {in, 3});
}

Shape::~Shape() { store_.remove(id_); }

Result<void> Shape::add_child(const Shape& child, const Pose& origin) {
  if (model_.kind != model::ShapeKind::compound) {
    return Error{fmt::format("shape '{}' is not a compound; create one with sim:add_compound_shape", name())};
  }
  if (&child == this) return Error{fmt::format("compound '{}' can't contain itself", name())};
  if (model::is_ground(child.model())) {
    return Error{fmt::format("compound '{}' can't contain a {}", name(),
                             child.model().surface != nullptr ? "surface; make a part of it" : "plane")};
  }
  if (children_.size() + child.placed().size() > 1000)
    return Error{fmt::format("compound '{}' can contain at most 1000 shapes", name())};
  for (model::PlacedShape placed : child.placed()) {
    placed.origin = origin * placed.origin;
    children_.push_back(placed);
  }
  geometry_ = nullptr;
  store_.bump_structure_version();
  return {};
}

void Shape::truncate_children(std::size_t count) {
  children_.resize(std::min(count, children_.size()));
  geometry_ = nullptr;
  store_.bump_structure_version();
}

std::vector<model::PlacedShape> Shape::placed() const {
  if (model_.kind == model::ShapeKind::compound) return children_;
  model::PlacedShape self;
  self.shape = model_;
  return {self};
}

void Shape::assign_geometry(const Shape& source) {
  model_ = source.model_;
  children_ = source.children_;
  geometry_ = source.geometry_;
  store_.bump_structure_version();
}

void Shape::set_color(const model::PlacedShape& visual) {
  if (!visual.color) return;
  const Vec3 hsb = hsb_of(*visual.color);
  for (const char* const property : kColors) {
    double* const out = store_.mutable_values(id_, table().at(property));
    for (int i = 0; i < 3; i++) out[i] = std::clamp(hsb[i], 0.0, 1.0);
  }
  store_.mutable_values(id_, table().at("transparency"))[0] = std::clamp(1 - visual.alpha, 0.0, 1.0);
}

std::shared_ptr<const Geometry> Shape::geometry() const {
  if (geometry_ == nullptr) geometry_ = make_geometry(placed(), model::Inertial{});
  return geometry_;
}

}  // namespace limber::sim
