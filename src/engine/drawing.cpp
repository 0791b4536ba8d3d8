// Who is drawn: shapes of the scene, visuals of URDF files; and the numbers behind it, by the tables' own offsets.
#include "engine/drawing.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "engine/snapshot.h"
#include "sim/world.h"

namespace limber {

namespace {

struct PlacedForm {
  std::uint32_t form = 0;
  Pose origin;
};

// finds the forms of parts; each shape and each model is looked at once
class FormFinder {
 public:
  FormFinder(const World& world, std::vector<DrawnForm>& forms) : world_(world), forms_(forms) {
    for (std::size_t i = 0; i < world.shapes().size(); i++)
      material_of_[world.shapes()[i]->id().slot] = static_cast<std::uint32_t>(i + 1);
  }

  const std::vector<PlacedForm>& of(const Part& part, std::size_t number) {
    if (world_.store().alive(part.shape())) return of_shape(part.shape());
    const auto& model = part.body().model();
    if (model == nullptr || number >= model->links.size()) return nothing_;
    std::vector<std::vector<PlacedForm>>& links = of_model_[model.get()];
    if (links.empty()) links = of_model(*model);
    return links[number];
  }

 private:
  const std::vector<PlacedForm>& of_shape(NodeId id) {
    const auto [known, fresh] = of_shape_.try_emplace(id.slot);
    if (!fresh) return known->second;
    const Shape& shape = *static_cast<const Shape*>(world_.store().thing(id));
    for (const PlacedShape& placed : shape.placed()) add(known->second, placed, material_of_[id.slot]);
    return known->second;
  }

  // a model that shows nothing at all is shown as it collides
  std::vector<std::vector<PlacedForm>> of_model(const BodyModel& model) {
    const bool shows =
        std::any_of(model.links.begin(), model.links.end(), [](const LinkModel& l) { return !l.visuals.empty(); });
    std::vector<std::vector<PlacedForm>> links(model.links.size());
    for (std::size_t i = 0; i < links.size(); i++) {
      const LinkModel& link = model.links[i];
      const std::vector<PlacedShape>& shown = shows ? link.visuals : link.collisions;
      for (std::size_t k = 0; k < shown.size(); k++) {
        const Shape* const shape = shows ? world_.find_shape(visual_shape_name(model, link, k)) : nullptr;
        add(links[i], shown[k], shape == nullptr ? 0 : material_of_[shape->id().slot]);
      }
    }
    return links;
  }

  void add(std::vector<PlacedForm>& to, const PlacedShape& placed, std::uint32_t material) {
    to.push_back({static_cast<std::uint32_t>(forms_.size()), placed.origin});
    forms_.push_back({placed.shape, material});
  }

  const World& world_;
  std::vector<DrawnForm>& forms_;
  const std::vector<PlacedForm> nothing_;
  std::unordered_map<std::uint32_t, std::uint32_t> material_of_;  // by the shape's slot; 0: the table's defaults
  std::unordered_map<std::uint32_t, std::vector<PlacedForm>> of_shape_;
  std::unordered_map<const BodyModel*, std::vector<std::vector<PlacedForm>>> of_model_;
};

// a row's place in its class's block
std::uint32_t at(const Table& table, std::string_view row) { return table.at(row).offset; }

}  // namespace

Drawing::Drawing(const World& world) {
  const StoreView& view = *world.store().view();
  const auto block = [&](NodeId id) { return Block{view.slots[id.slot].kept, world.store().table(id).kept_width()}; };
  blocks_ = {block(world.visuals().id()), block(world.visuals().camera().id()), block(world.visuals().look().id())};
  for (const auto& shape : world.shapes()) blocks_.push_back(block(shape->id()));

  FormFinder finder(world, forms);
  const std::uint32_t enabled = Body::table().at("enabled").offset;
  for (const auto& body : world.bodies()) {
    const std::uint32_t enabled_at = view.slots[body->id().slot].live + enabled;
    for (std::size_t i = 0; i < body->parts().size(); i++) {
      const Part& part = *body->parts()[i];
      for (const PlacedForm& placed : finder.of(part, i))
        pieces.push_back({view.slots[part.id().slot].live, enabled_at, placed.form, placed.origin});
    }
  }
}

void Drawing::copy_visuals(std::span<const double> kept, std::vector<double>& to) const {
  to.clear();
  for (const Block& block : blocks_) {
    const double* const from = kept.data() + block.at;
    to.insert(to.end(), from, from + block.width);
  }
}

Material material_of(const Snapshot& snapshot, std::uint32_t material) {
  static const Table& table = Shape::table();
  static const std::uint32_t first =
      Visuals::table().kept_width() + Camera::table().kept_width() + Look::table().kept_width();
  static const std::vector<double> defaults = [] {
    std::vector<double> all(table.kept_width());
    for (const Row& row : table.rows()) std::copy_n(row.initial.begin(), row.width, all.begin() + row.offset);
    return all;
  }();
  const double* const v =
      material == 0 ? defaults.data() : snapshot.visuals.data() + first + (material - 1) * table.kept_width();
  return {v[at(table, "transparency")],           v[at(table, "ambient_scale")],
          v[at(table, "diffuse_scale")],          v[at(table, "specular_scale")],
          v[at(table, "specular_pow")],           vec3_at(v + at(table, "ambient_color")),
          vec3_at(v + at(table, "diffuse_color"))};
}

CameraView camera_of(const Snapshot& snapshot) {
  static const Table& table = Camera::table();
  const double* const v = snapshot.visuals.data() + Visuals::table().kept_width();
  return {vec3_at(v + at(table, "position")),
          vec3_at(v + at(table, "rotation")),
          v[at(table, "fovy")],
          v[at(table, "aspect")],
          v[at(table, "near")],
          v[at(table, "far")],
          v[at(table, "distance")]};
}

LookView look_of(const Snapshot& snapshot) {
  static const Table& table = Look::table();
  static const Row& background = Visuals::table().at("background");
  const double* const b = snapshot.visuals.data() + background.offset;
  const double* const v = snapshot.visuals.data() + Visuals::table().kept_width() + Camera::table().kept_width();
  const bool own = !std::equal(b, b + 3, background.initial.begin());
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
          own};
}

}  // namespace limber
