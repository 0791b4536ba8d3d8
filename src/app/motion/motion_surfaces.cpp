// Builds surfaces from the view's meshes at medium detail, without duplicate vertices.
#include "app/motion/motion_surfaces.h"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <utility>

#include "base/color.h"
#include "ui/render/mesh.h"

namespace limber::app {

namespace {

constexpr double kMinAlpha = 0.002;  // alpha below which a surface is left out

struct Paint {
  Vec3 color{0};
  double alpha = 1;
  bool colored = false;  // vertices have colors of their own

  bool matches(const exporter::Surface& surface) const {
    return surface.color == color && surface.alpha == alpha && surface.colors.empty() != colored;
  }
};

// the factor 2 is for ofxDabPhysics: its scale is 0.5 for a surface of full brightness
Paint paint_of(const engine::Material& material, const engine::Tint& tint) {
  const Vec3 rgb = rgb_of(material.diffuse_color);
  Paint paint;
  for (int i = 0; i < 3; i++)
    paint.color[i] =
        std::clamp(2 * material.diffuse_scale * linear_light_of(rgb[i]) * linear_light_of(tint.color[i]), 0.0, 1.0);
  paint.alpha = (1 - material.transparency) * (1 - tint.transparency);
  return paint;
}

void add_number(std::string& key, double number) { key.append(reinterpret_cast<const char*>(&number), sizeof number); }
void add_vec(std::string& key, const Vec3& v) {
  for (int i = 0; i < 3; i++) add_number(key, v[i]);
}
void add_pose(std::string& key, const Pose& pose) {
  add_vec(key, pose.position);
  for (int i = 0; i < 4; i++) add_number(key, pose.rotation[i]);
}

void add_piece(std::string& key, const model::ShapeModel& shape, const Pose& origin, const Paint& paint) {
  const model::MeshModel* const mesh = shape.mesh.get();
  key.append(reinterpret_cast<const char*>(&mesh), sizeof mesh);
  add_number(key, static_cast<double>(shape.kind));
  add_number(key, shape.mesh_colors ? 1 : 0);
  add_vec(key, shape.normal);
  add_vec(key, shape.size);
  add_number(key, shape.radius);
  add_number(key, shape.height);
  add_pose(key, shape.mesh_pose);
  add_pose(key, origin);
  add_vec(key, paint.color);
  add_number(key, paint.alpha);
}

// appends to a surface and merges equal vertices
class Builder {
 public:
  explicit Builder(exporter::Surface& surface) : surface_(surface) {}

  void add(const Pose& at, const Vec3& point, const Vec3& normal, const Vec3* color = nullptr) {
    const Vec3 p = at * point;
    const Vec3 n = normalized(at.rotation * normal);
    const Vec3 c = color != nullptr ? *color : Vec3(1);
    const auto f = [](double v) { return static_cast<float>(v) + 0.0F; };  // no negative zero
    const std::array<float, 9> all = {f(p.x), f(p.y), f(p.z), f(n.x), f(n.y), f(n.z), f(c.x), f(c.y), f(c.z)};
    const auto [entry, fresh] = indices_.try_emplace(all, static_cast<std::uint32_t>(surface_.points.size()));
    if (fresh) {
      surface_.points.push_back({all[0], all[1], all[2]});
      surface_.normals.push_back({all[3], all[4], all[5]});
      if (color != nullptr) surface_.colors.push_back({all[6], all[7], all[8]});
    }
    surface_.triangles.push_back(entry->second);
  }

 private:
  exporter::Surface& surface_;
  std::map<std::array<float, 9>, std::uint32_t> indices_;
};

// the surfaces of a link
class SurfaceList {
 public:
  // `count`: at least the number of surfaces; builders refer to them
  explicit SurfaceList(std::size_t count) { surfaces_.reserve(count); }

  Builder& with(const Paint& paint) {
    std::size_t n = 0;
    while (n < surfaces_.size() && !paint.matches(surfaces_[n])) n++;
    if (n < surfaces_.size()) return builders_[n];
    exporter::Surface& surface = surfaces_.emplace_back();
    surface.color = paint.color;
    surface.alpha = paint.alpha;
    return builders_.emplace_back(surface);
  }
  exporter::Surfaces release() {
    std::erase_if(surfaces_, [](const exporter::Surface& surface) { return surface.triangles.empty(); });
    return std::move(surfaces_);
  }

 private:
  exporter::Surfaces surfaces_;
  std::deque<Builder> builders_;  // references stay valid
};

void add_plane(Builder& builder, const Pose& at, const Vec3& up) {
  const Vec3 n = normalized(up);
  const Vec3 u = normalized(glm::cross(std::abs(n.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0), n)) * (kPlaneEdge / 2);
  const Vec3 v = glm::cross(n, u);
  for (const Vec3& corner : {-u - v, u - v, u + v, -u - v, u + v, v - u}) builder.add(at, corner, n);
}

void add_plain(Builder& builder, const model::ShapeModel& shape, const Pose& origin) {
  const bool of_file = shape.mesh != nullptr;
  const render::MeshVertices vertices =
      of_file ? render::model_mesh(*shape.mesh, 0) : render::primitive_mesh(shape.kind, 1);
  const render::MeshSize size = of_file ? render::MeshSize{} : render::mesh_size(shape);
  const Pose at = of_file ? origin * shape.mesh_pose : origin;
  for (const render::MeshVertex& vertex : vertices) {
    const Vec3 corner(vertex.corner[0], vertex.corner[1], vertex.corner[2]);
    const Vec3 normal(vertex.normal[0], vertex.normal[1], vertex.normal[2]);
    // shapes without a round part are scaled, their normals inversely
    builder.add(at, corner * size.extent + normal * size.rounding_radius,
                size.rounding_radius > 0 ? normal : normal / size.extent);
  }
}

// a mesh in its own colors: a surface for each of its parts, with a color for each vertex; textures are left out
void add_colored(SurfaceList& surfaces, const model::ShapeModel& shape, const Pose& origin, Paint paint) {
  const Pose at = origin * shape.mesh_pose;
  const double alpha = paint.alpha;
  const std::vector<render::MeshPart> parts = render::mesh_parts(shape);
  const std::vector<render::ColoredVertices> meshes = render::colored_meshes(shape, 0);
  paint.colored = true;
  for (std::size_t i = 0; i < meshes.size(); i++) {
    paint.alpha = alpha * parts[i].alpha;
    Builder& builder = surfaces.with(paint);
    for (const render::ColoredVertex& v : meshes[i]) {
      Vec3 color;
      for (int k = 0; k < 3; k++) color[k] = linear_light_of(v.color[k] / 255.0);
      builder.add(at, {v.corner[0], v.corner[1], v.corner[2]}, {v.normal[0], v.normal[1], v.normal[2]}, &color);
    }
  }
}

void add_shape(SurfaceList& surfaces, const model::ShapeModel& shape, const Pose& origin, const Paint& paint) {
  if (render::coloring_of(shape) == render::MeshColoring::own) {
    add_colored(surfaces, shape, origin, paint);
  } else if (shape.mesh == nullptr && shape.kind == model::ShapeKind::plane) {
    add_plane(surfaces.with(paint), origin, shape.normal);
  } else {
    add_plain(surfaces.with(paint), shape, origin);
  }
}

}  // namespace

std::shared_ptr<const exporter::Surfaces> MotionSurfaces::surfaces_of(
    const engine::Snapshot& snapshot, std::span<const engine::RenderInstance> instances) {
  std::string key;
  std::vector<Paint> paints;
  for (const engine::RenderInstance& instance : instances) {
    const engine::RenderShape& form = snapshot.render_scene->shapes[instance.shape];
    paints.push_back(paint_of(engine::material_of(snapshot, form.material), engine::tint_of(snapshot, instance)));
    add_piece(key, form.geometry, instance.origin, paints.back());
  }
  const auto [at, fresh] = cache_.try_emplace(key);
  if (!fresh) return at->second.surfaces;
  std::size_t count = 0;
  for (const engine::RenderInstance& instance : instances)
    count += render::mesh_parts(snapshot.render_scene->shapes[instance.shape].geometry).size();
  SurfaceList list(count);
  for (std::size_t i = 0; i < instances.size(); i++) {
    if (paints[i].alpha < kMinAlpha) continue;
    const model::ShapeModel& shape = snapshot.render_scene->shapes[instances[i].shape].geometry;
    add_shape(list, shape, instances[i].origin, paints[i]);
    at->second.meshes.push_back(shape.mesh);
  }
  exporter::Surfaces surfaces = list.release();
  if (!surfaces.empty()) at->second.surfaces = std::make_shared<const exporter::Surfaces>(std::move(surfaces));
  return at->second.surfaces;
}

}  // namespace limber::app
