// RenderScene: collects the shapes of the scene and the visuals of URDF files, and reads their properties by the
// offsets of the property tables.
#include "engine/output/render_scene.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "base/color.h"
#include "engine/output/snapshot.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/tendons/tendon_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::engine {

namespace {

struct PlacedRenderShape {
  std::uint32_t shape = 0;
  Pose origin;
};

// Finds the render shapes of parts; caches those of each shape and model.
class RenderShapeCollector {
 public:
  RenderShapeCollector(const sim::World& world, std::vector<RenderShape>& shapes) : world_(world), shapes_(shapes) {
    for (std::size_t i = 0; i < world.shapes().list().size(); i++)
      material_of_[world.shapes().list()[i]->id().slot] = static_cast<std::uint32_t>(i + 1);
  }

  const std::vector<PlacedRenderShape>& shapes_of(const sim::Part& part, std::size_t link_index) {
    if (world_.store().alive(part.shape())) return of_shape(part.shape());
    const auto& model = part.body().model();
    if (model == nullptr || link_index >= model->links.size()) return none_;
    std::vector<std::vector<PlacedRenderShape>>& links = of_model_[model.get()];
    if (links.empty()) links = of_model(*model);
    return links[link_index];
  }

 private:
  const std::vector<PlacedRenderShape>& of_shape(NodeId id) {
    const auto [known, is_new] = of_shape_.try_emplace(id.slot);
    if (!is_new) return known->second;
    const sim::Shape& shape = *static_cast<const sim::Shape*>(world_.store().object(id));
    for (const model::PlacedShape& placed : shape.placed()) add(known->second, placed, material_of_[id.slot]);
    return known->second;
  }

  // A model without any visuals is drawn with its collision shapes.
  std::vector<std::vector<PlacedRenderShape>> of_model(const model::BodyModel& model) {
    const bool has_visuals = std::any_of(model.links.begin(), model.links.end(),
                                         [](const model::LinkModel& l) { return !l.visuals.empty(); });
    std::vector<std::vector<PlacedRenderShape>> links(model.links.size());
    for (std::size_t i = 0; i < links.size(); i++) {
      const model::LinkModel& link = model.links[i];
      const std::vector<model::PlacedShape>& placed_shapes = has_visuals ? link.visuals : link.collisions;
      for (std::size_t k = 0; k < placed_shapes.size(); k++) {
        const sim::Shape* const shape =
            has_visuals ? world_.shapes().find(sim::visual_shape_name(model, link, k)) : nullptr;
        add(links[i], placed_shapes[k], shape == nullptr ? 0 : material_of_[shape->id().slot]);
      }
    }
    return links;
  }

  void add(std::vector<PlacedRenderShape>& to, const model::PlacedShape& placed, std::uint32_t material) {
    to.push_back({static_cast<std::uint32_t>(shapes_.size()), placed.origin});
    shapes_.push_back({placed.shape, material});
  }

  const sim::World& world_;
  std::vector<RenderShape>& shapes_;
  const std::vector<PlacedRenderShape> none_;
  std::unordered_map<std::uint32_t, std::uint32_t> material_of_;  // by the shape's slot; 0: default values
  std::unordered_map<std::uint32_t, std::vector<PlacedRenderShape>> of_shape_;
  std::unordered_map<const model::BodyModel*, std::vector<std::vector<PlacedRenderShape>>> of_model_;
};

// `tint` and `transparency` of a part, which are neighbors in its block
constexpr std::uint32_t kTintWidth = 4;

// offset of a property in its object's block
std::uint32_t at(const PropertyTable& table, std::string_view property) { return table.at(property).offset; }

}  // namespace

RenderScene::RenderScene(const sim::World& world) {
  const StoreView& view = *world.store().view();
  const auto block = [&](NodeId id) {
    return Block{view.slots[id.slot].persistent, world.store().table(id).persistent_width()};
  };
  blocks_ = {block(world.visuals().id()), block(world.visuals().camera().id()),
             block(world.visuals().appearance().id())};
  for (const auto& shape : world.shapes().list()) blocks_.push_back(block(shape->id()));

  std::uint32_t tint = 0;
  for (const Block& each : blocks_) tint += each.width;
  const std::uint32_t tint_offset = sim::Part::table().at("tint").offset;
  RenderShapeCollector collector(world, shapes);
  const std::uint32_t enabled = sim::Body::table().at("enabled").offset;
  for (const auto& body : world.bodies()) {
    const std::uint32_t enabled_offset = view.slots[body->id().slot].transient + enabled;
    for (std::size_t i = 0; i < body->parts().size(); i++) {
      const sim::Part& part = *body->parts()[i];
      const std::vector<PlacedRenderShape>& of_part = collector.shapes_of(part, i);
      if (of_part.empty()) continue;
      for (const PlacedRenderShape& placed : of_part)
        instances.push_back({view.slots[part.id().slot].transient, enabled_offset, placed.shape, placed.origin, tint});
      blocks_.push_back({view.slots[part.id().slot].persistent + tint_offset, kTintWidth});
      tint += kTintWidth;
    }
  }
  add_tendons(world, tint);
  for (const auto& fixture : world.visuals().fixtures().list())
    beams.push_back({view.slots[fixture->id().slot].transient});
}

// `offset`: index of the first radius in Snapshot::visuals
void RenderScene::add_tendons(const sim::World& world, std::uint32_t offset) {
  const StoreView& view = *world.store().view();
  const PropertyTable& table = sim::Tendon::table();
  for (const auto& tendon : world.tendons().list()) {
    RenderTendon& out = tendons.emplace_back();
    for (const sim::Tendon::Point& point : tendon->points())
      out.points.push_back({view.slots[point.part->id().slot].transient, point.position});
    out.enabled_offset = view.slots[tendon->body().id().slot].transient + at(sim::Body::table(), "enabled");
    out.force_offset = view.slots[tendon->id().slot].transient + at(table, "force");
    out.radius = offset++;
    blocks_.push_back({view.slots[tendon->id().slot].persistent + at(table, "radius"), 1});
  }
}

void RenderScene::copy_visuals(std::span<const double> persistent, std::vector<double>& to) const {
  to.clear();
  for (const Block& block : blocks_) {
    const double* const from = persistent.data() + block.offset;
    to.insert(to.end(), from, from + block.width);
  }
}

Material material_of(const Snapshot& snapshot, std::uint32_t material) {
  static const PropertyTable& table = sim::Shape::table();
  static const std::uint32_t first = sim::Visuals::table().persistent_width() +
                                     sim::Camera::table().persistent_width() +
                                     sim::Appearance::table().persistent_width();
  static const std::vector<double> defaults = [] {
    std::vector<double> all(table.persistent_width());
    for (const Property& property : table.properties())
      std::copy_n(property.initial.begin(), property.width, all.begin() + property.offset);
    return all;
  }();
  const double* const v =
      material == 0 ? defaults.data() : snapshot.visuals.data() + first + (material - 1) * table.persistent_width();
  const Vec3 diffuse = vec3_at(v + at(table, "diffuse_color"));
  const Vec3 ambient = vec3_at(v + at(table, "ambient_color"));
  const bool ambient_is_default = ambient == vec3_at(defaults.data() + at(table, "ambient_color"));
  return {v[at(table, "transparency")],
          v[at(table, "ambient_scale")],
          v[at(table, "diffuse_scale")],
          v[at(table, "specular_scale")],
          v[at(table, "specular_pow")],
          ambient_is_default ? diffuse : ambient,
          diffuse};
}

Tint tint_of(const Snapshot& snapshot, const RenderInstance& instance) {
  const double* const v = snapshot.visuals.data() + instance.tint;
  const Vec3 hsb = vec3_at(v);
  // the default is exactly white
  return {hsb == Vec3(0, 0, 1) ? Vec3(1) : rgb_of(hsb), v[kTintWidth - 1]};
}

Beam beam_of(const Snapshot& snapshot, const RenderBeam& beam) {
  static const PropertyTable& table = sim::Fixture::table();
  const double* const v = snapshot.transient.data() + beam.offset;
  return {vec3_at(v + at(table, "origin")), vec3_at(v + at(table, "direction")), vec3_at(v + at(table, "light")),
          v[at(table, "beam_angle")] * kPi / 180};
}

double radius_of(const Snapshot& snapshot, const RenderTendon& tendon) { return snapshot.visuals[tendon.radius]; }

CameraSettings camera_of(const Snapshot& snapshot) {
  static const PropertyTable& table = sim::Camera::table();
  const double* const v = snapshot.visuals.data() + sim::Visuals::table().persistent_width();
  return {vec3_at(v + at(table, "position")),
          vec3_at(v + at(table, "rotation")),
          v[at(table, "fovy")],
          v[at(table, "aspect")],
          v[at(table, "near")],
          v[at(table, "far")],
          v[at(table, "distance")]};
}

AppearanceSettings appearance_of(const Snapshot& snapshot) {
  static const PropertyTable& table = sim::Appearance::table();
  static const Property& background = sim::Visuals::table().at("background");
  const double* const b = snapshot.visuals.data() + background.offset;
  const double* const v =
      snapshot.visuals.data() + sim::Visuals::table().persistent_width() + sim::Camera::table().persistent_width();
  const bool custom = !std::equal(b, b + 3, background.initial.begin());
  return {v[at(table, "style")] != 0,
          v[at(table, "exposure")],
          v[at(table, "ambient")],
          v[at(table, "lamp")],
          v[at(table, "rim")],
          v[at(table, "shadow")],
          v[at(table, "fog")],
          v[at(table, "grid")],
          v[at(table, "mirror")],
          v[at(table, "floor")] != 0,
          vec3_at(b),
          custom};
}

}  // namespace limber::engine
