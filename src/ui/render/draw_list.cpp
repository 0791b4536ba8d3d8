// Converts the instances of a scene and their poses to batches.
#include "ui/render/draw_list.h"

#include <algorithm>
#include <cmath>

#include "base/color.h"

namespace limber::render {

namespace {

constexpr float kMinVisibleAlpha = 0.002F;  // alpha below which instances are not drawn
constexpr float kMinShadowAlpha = 0.5F;     // alpha below which instances cast no shadow
constexpr std::size_t kMaxBoundsSamples = 2000;

float to_float(double v) { return static_cast<float>(v); }
glm::vec3 to_float(const Vec3& v) { return {to_float(v.x), to_float(v.y), to_float(v.z)}; }

double bounding_radius(const model::ShapeModel& shape) {
  double far = 0;
  if (shape.mesh != nullptr) {
    for (const Vec3& v : shape.mesh->vertices) far = std::max(far, glm::length(shape.mesh_pose * v));
    return far;
  }
  const double half = shape.height / 2;
  switch (shape.kind) {
    case model::ShapeKind::box:
      return glm::length(shape.size) / 2;
    case model::ShapeKind::ellipsoid:
      return std::max({shape.size.x, shape.size.y, shape.size.z}) / 2;
    case model::ShapeKind::sphere:
      return shape.radius;
    case model::ShapeKind::capsule:
      return shape.radius + half;
    default:
      return std::hypot(shape.radius, half);
  }
}

// `mix`: 0 (`from`) to 1 (`to`); rotations are interpolated linearly, which suffices for the angles of a tick
Pose interpolate(const Pose& from, const Pose& to, double mix) {
  const Quat rotation = glm::dot(from.rotation, to.rotation) < 0 ? -to.rotation : to.rotation;
  return {glm::mix(from.position, to.position, mix), glm::normalize(from.rotation * (1 - mix) + rotation * mix)};
}

// Rotation that turns z to a unit vector.
Quat rotation_to(const Vec3& direction) {
  if (direction.z < -1 + 1e-9) return {0, 1, 0, 0};
  const Vec3 axis = glm::cross(Vec3(0, 0, 1), direction);
  return glm::normalize(Quat(1 + direction.z, axis.x, axis.y, axis.z));
}

// Red, green and blue of a tension: pale while slack, yellow at 10 N, orange at 100 N, red from 1 kN on.
Vec3 tension_color(double force) {
  constexpr Vec3 kColors[] = {{0.93, 0.93, 0.90}, {1.0, 0.85, 0.35}, {1.0, 0.5, 0.12}, {0.85, 0.1, 0.1}};
  const double place = std::clamp(std::log10(1 + std::abs(force)), 0.0, 3.0);
  const auto index = std::min<std::size_t>(2, static_cast<std::size_t>(place));
  return glm::mix(kColors[index], kColors[index + 1], place - static_cast<double>(index));
}

}  // namespace

// ofxDabPhysics's scales of diffuse and ambient light are 0.5 for full reflection, hence the factor 2; its exponents
// are for Phong highlights, the shader's for Blinn-Phong, hence the factor 4
DrawList::InstanceMaterial DrawList::instance_material(const engine::Material& m) {
  InstanceMaterial out{};
  const Vec3 diffuse = rgb_of(m.diffuse_color);
  const Vec3 ambient = rgb_of(m.ambient_color);
  for (int i = 0; i < 3; i++) {
    out.diffuse[i] = to_float(2 * m.diffuse_scale * linear_light_of(diffuse[i]));
    out.ambient[i] = to_float(2 * m.ambient_scale * linear_light_of(ambient[i]));
  }
  out.alpha = to_float(1 - m.transparency);
  out.specular = to_float(m.specular_scale);
  out.specular_exponent = to_float(10 + 4 * m.specular_pow);
  return out;
}

void DrawList::rebuild_shapes(const engine::Snapshot& current) {
  scene_ = current.render_scene;
  meshes_.clear();
  shapes_.clear();
  first_part_.clear();
  models_.clear();
  images_.clear();
  std::map<MeshKey, std::uint32_t> numbers;
  for (const engine::RenderShape& render_shape : scene_->shapes) {
    const model::ShapeModel& shape = render_shape.geometry;
    ShapeDraw shape_draw;
    shape_draw.material = render_shape.material;
    shape_draw.normal = shape.normal;
    shape_draw.bounding_radius = bounding_radius(shape);
    shape_draw.mesh = {shape.kind, nullptr};
    if (shape.mesh != nullptr) {
      shape_draw.mesh = {model::ShapeKind::mesh, shape.mesh.get()};
      shape_draw.offset = shape.mesh_pose;
      models_[shape.mesh.get()] = shape.mesh;
    }
    const MeshSize size = shape.mesh != nullptr ? MeshSize{} : mesh_size(shape);
    for (int i = 0; i < 3; i++) shape_draw.size.extent[i] = to_float(size.extent[i]);
    shape_draw.size.rounding_radius = to_float(size.rounding_radius);
    first_part_.push_back(static_cast<std::uint32_t>(shapes_.size()));
    shape_draw.mesh.coloring = coloring_of(shape);
    const bool plain = shape_draw.mesh.coloring == MeshColoring::plain;
    for (const MeshPart& part : plain ? std::vector<MeshPart>(1) : mesh_parts(shape)) {
      shape_draw.mesh.texture = part.texture.get();
      shape_draw.alpha = to_float(part.alpha);
      if (part.texture != nullptr) images_[part.texture.get()] = part.texture;
      const auto [number, fresh] = numbers.try_emplace(shape_draw.mesh, static_cast<std::uint32_t>(meshes_.size()));
      if (fresh) meshes_.push_back(shape_draw.mesh);
      shape_draw.mesh_index = number->second;
      shapes_.push_back(shape_draw);
      shape_draw.mesh.part++;
      shape_draw.first_part = false;
    }
  }
  first_part_.push_back(static_cast<std::uint32_t>(shapes_.size()));
  if (scene_->tendons.empty()) return;
  tendon_shape_.mesh = {model::ShapeKind::cylinder, nullptr};
  const auto [number, fresh] = numbers.try_emplace(tendon_shape_.mesh, static_cast<std::uint32_t>(meshes_.size()));
  if (fresh) meshes_.push_back(tendon_shape_.mesh);
  tendon_shape_.mesh_index = number->second;
  tendon_shape_.first_part = false;  // it doesn't extend the bounds of the scene
}

void DrawList::update_materials(const engine::Snapshot& current) {
  materials_version_ = current.visuals_version;
  std::uint32_t max_material = 0;
  for (const ShapeDraw& shape : shapes_) max_material = std::max(max_material, shape.material);
  materials_.clear();
  for (std::uint32_t i = 0; i <= max_material; i++)
    materials_.push_back(instance_material(engine::material_of(current, i)));
  update_tints(current);
}

void DrawList::update_tints(const engine::Snapshot& current) {
  tints_.clear();
  for (const engine::RenderInstance& instance : scene_->instances) {
    const engine::Tint tint = engine::tint_of(current, instance);
    for (int i = 0; i < 3; i++) tints_.push_back(tint.color[i] == 1 ? 1 : to_float(linear_light_of(tint.color[i])));
    tints_.push_back(to_float(1 - tint.transparency));
  }
}

void DrawList::add_instance(const ShapeDraw& shape, const Pose& pose, const float* tint, const DrawCamera& camera) {
  InstanceMaterial material = materials_[shape.material];
  for (int i = 0; i < 3; i++) {
    material.diffuse[i] *= tint[i];
    material.ambient[i] *= tint[i];
  }
  material.alpha *= tint[3] * shape.alpha;
  if (material.alpha < kMinVisibleAlpha || !is_finite(pose.position) || !is_finite(pose.rotation)) return;
  if (shape.mesh.kind == model::ShapeKind::plane) {
    planes_.push_back({to_float(pose.position),
                       to_float(pose.rotation * shape.normal),
                       {material.diffuse[0], material.diffuse[1], material.diffuse[2]},
                       material.alpha});
    return;
  }
  const Pose at = pose * shape.offset;
  Instance instance{};
  const glm::vec3 position = to_float(at.position);
  for (int i = 0; i < 3; i++) {
    instance.position[i] = position[i];
    instance.extent[i] = shape.size.extent[i];
    instance.diffuse[i] = material.diffuse[i];
    instance.ambient[i] = material.ambient[i];
  }
  instance.rounding_radius = shape.size.rounding_radius;
  instance.specular = material.specular;
  instance.specular_exponent = material.specular_exponent;
  instance.alpha = material.alpha;
  instance.rotation[0] = to_float(at.rotation.x);
  instance.rotation[1] = to_float(at.rotation.y);
  instance.rotation[2] = to_float(at.rotation.z);
  instance.rotation[3] = to_float(at.rotation.w);
  const double depth = glm::dot(at.position - camera.position, camera.forward);
  const double pixels = shape.bounding_radius * camera.focal_pixels / std::max(depth, 0.1);
  const int detail = std::min(kDetailLevels - 1, (pixels > 40   ? 0
                                                  : pixels > 12 ? 1
                                                  : pixels > 4  ? 2
                                                                : 3) +
                                                     camera.detail_bias);
  const auto key = shape.mesh_index * kDetailLevels + static_cast<std::uint32_t>(detail);
  (material.alpha < 1 ? transparent_instances_ : opaque_instances_).push_back({instance, key, to_float(depth)});
  if (!shape.first_part) return;
  positions_.push_back(position);
  radii_.push_back(to_float(shape.bounding_radius));
}

// A cylinder for each segment of the line through tendon_points_.
void DrawList::add_tendon(const engine::RenderTendon& tendon, const engine::Snapshot& current,
                          const DrawCamera& camera) {
  const double radius = engine::radius_of(current, tendon);
  if (radius <= 0) return;
  const Vec3 color = tension_color(current.transient[tendon.force_offset]);
  const float tint[4] = {to_float(linear_light_of(color.x)), to_float(linear_light_of(color.y)),
                         to_float(linear_light_of(color.z)), 1};
  for (std::size_t i = 1; i < tendon_points_.size(); i++) {
    const Vec3 from = tendon_points_[i - 1];
    const Vec3 along = tendon_points_[i] - from;
    const double length = glm::length(along);
    if (!(length > 1e-9)) continue;
    model::ShapeModel shape;
    shape.kind = model::ShapeKind::cylinder;
    shape.radius = radius;
    shape.height = length;
    const MeshSize size = mesh_size(shape);
    for (int axis = 0; axis < 3; axis++) tendon_shape_.size.extent[axis] = to_float(size.extent[axis]);
    tendon_shape_.size.rounding_radius = to_float(size.rounding_radius);
    tendon_shape_.bounding_radius = bounding_radius(shape);
    add_instance(tendon_shape_, {from + along / 2.0, rotation_to(along / length)}, tint, camera);
  }
}

void DrawList::update(const engine::Snapshot& previous, const engine::Snapshot& current, double mix,
                      const DrawCamera& camera) {
  if (scene_ != current.render_scene) {
    rebuild_shapes(current);
    update_materials(current);
  } else if (materials_version_ != current.visuals_version) {
    update_materials(current);
  }
  const bool interpolates =
      mix < 1 && previous.render_scene == current.render_scene && previous.transient.size() == current.transient.size();
  opaque_instances_.clear();
  transparent_instances_.clear();
  planes_.clear();
  positions_.clear();
  radii_.clear();
  for (std::size_t i = 0; i < scene_->instances.size(); i++) {
    const engine::RenderInstance& instance = scene_->instances[i];
    if (current.transient[instance.enabled_offset] == 0) continue;
    Pose part = engine::part_pose(current, instance.part_offset);
    if (interpolates) part = interpolate(engine::part_pose(previous, instance.part_offset), part, mix);
    for (std::uint32_t k = first_part_[instance.shape]; k < first_part_[instance.shape + 1]; k++)
      add_instance(shapes_[k], part * instance.origin, tints_.data() + 4 * i, camera);
  }
  for (const engine::RenderTendon& tendon : scene_->tendons) {
    if (current.transient[tendon.enabled_offset] == 0) continue;
    tendon_points_.clear();
    for (const engine::RenderTendon::Point& point : tendon.points) {
      Pose part = engine::part_pose(current, point.part_offset);
      if (interpolates) part = interpolate(engine::part_pose(previous, point.part_offset), part, mix);
      tendon_points_.push_back(part * point.position);
    }
    add_tendon(tendon, current, camera);
  }
  compute_bounds();
  build_batches();
}

// The center is the middle between the 10th and 90th percentile along each axis, the radius the 90th percentile of the
// distance: a few bodies that fall forever change neither. Large scenes are sampled.
void DrawList::compute_bounds() {
  center_ = glm::vec3(0);
  radius_ = 1;
  if (positions_.empty()) return;
  const std::size_t stride = (positions_.size() + kMaxBoundsSamples - 1) / kMaxBoundsSamples;
  const auto fill = [&](auto&& number) {
    scratch_numbers_.clear();
    for (std::size_t i = 0; i < positions_.size(); i += stride) scratch_numbers_.push_back(number(i));
  };
  const auto value_at_rank = [&](double rank) {
    std::nth_element(scratch_numbers_.begin(), scratch_numbers_.begin() + static_cast<std::ptrdiff_t>(rank),
                     scratch_numbers_.end());
    return scratch_numbers_[static_cast<std::size_t>(rank)];
  };
  const auto last = static_cast<double>((positions_.size() - 1) / stride);
  for (int axis = 0; axis < 3; axis++) {
    fill([&](std::size_t i) { return positions_[i][axis]; });
    const float low = value_at_rank(std::floor(0.1 * last));
    center_[axis] = (low + value_at_rank(std::ceil(0.9 * last))) / 2;
  }
  fill([&](std::size_t i) { return glm::distance(positions_[i], center_) + radii_[i]; });
  radius_ = value_at_rank(std::ceil(0.9 * last));
}

// Stable counting sort by mesh and detail.
void DrawList::sort_opaque() {
  first_.assign(meshes_.size() * kDetailLevels + 1, 0);
  for (const VisibleInstance& s : opaque_instances_) first_[s.key + 1]++;
  for (std::size_t k = 1; k < first_.size(); k++) first_[k] += first_[k - 1];
  order_.resize(opaque_instances_.size());
  for (std::size_t i = 0; i < opaque_instances_.size(); i++)
    order_[first_[opaque_instances_[i].key]++] = static_cast<std::uint32_t>(i);
}

void DrawList::sort_transparent() {
  order_.resize(transparent_instances_.size());
  for (std::size_t i = 0; i < order_.size(); i++) order_[i] = static_cast<std::uint32_t>(i);
  std::stable_sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
    return transparent_instances_[a].depth > transparent_instances_[b].depth;
  });
}

void DrawList::add_in_order(std::vector<Batch>& batches, const std::vector<VisibleInstance>& visible) {
  batches.clear();
  std::uint32_t last = 0;
  for (const std::uint32_t i : order_) {
    const VisibleInstance& s = visible[i];
    const bool casts = s.instance.alpha >= kMinShadowAlpha;
    if (batches.empty() || s.key != last || batches.back().casts_shadow != casts) {
      batches.push_back({meshes_[s.key / kDetailLevels], static_cast<int>(s.key % kDetailLevels),
                         static_cast<std::uint32_t>(instances_.size()), 0, casts});
      last = s.key;
    }
    instances_.push_back(s.instance);
    batches.back().count++;
  }
}

void DrawList::build_batches() {
  instances_.clear();
  sort_opaque();
  add_in_order(opaque_, opaque_instances_);
  sort_transparent();
  add_in_order(transparent_, transparent_instances_);
}

}  // namespace limber::render
