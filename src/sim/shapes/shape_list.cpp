// ShapeList: adding and removing shapes; geometries of models.
#include "sim/shapes/shape_list.h"

#include <utility>

#include <fmt/format.h>

#include "sim/shapes/geometry.h"
#include "sim/state/world_transaction.h"

namespace limber::sim {

Result<Shape*> ShapeList::add(std::string name, model::ShapeModel model) {
  if (const Result<void> available = shapes_.check_new_name("shape", name); !available) return Error{available.error()};
  if (const Result<void> valid = check_shape(model); !valid) {
    return Error{fmt::format("shape '{}': {}", name, valid.error())};
  }
  Shape& shape = shapes_.add(std::make_unique<Shape>(store_, shapes_.group(), std::move(name), std::move(model)));
  transaction_.record_added(shapes_.objects());
  return &shape;
}

void ShapeList::add_visuals(const model::BodyModel& model) {
  for (const model::LinkModel& link : model.links) {
    for (std::size_t i = 0; i < link.visuals.size(); i++) {
      const model::PlacedShape& visual = link.visuals[i];
      std::string name = visual_shape_name(model, link, i);
      if (find(name) != nullptr) continue;
      if (const Result<Shape*> shape = add(std::move(name), visual.shape)) (*shape)->set_color(visual);
    }
  }
}

void ShapeList::remove(Shape& shape) {
  std::erase_if(shapes_.objects(), [&](const std::unique_ptr<Shape>& each) { return each.get() == &shape; });
}

void ShapeList::clear() {
  shapes_.objects().clear();
  geometries_.clear();
}

NodeId ShapeList::matching(const Store& other, NodeId shape) const {
  if (&other == &store_ || !other.alive(shape)) return shape;
  const Shape* const found = find(other.name(shape));
  return found == nullptr ? NodeId{} : found->id();
}

const std::vector<std::shared_ptr<const Geometry>>& ShapeList::geometries_of(
    const std::shared_ptr<const model::BodyModel>& model) {
  ModelGeometry& cached = geometries_[model.get()];
  if (cached.model == nullptr) {
    cached.model = model;
    for (const model::LinkModel& link : model->links)
      cached.links.push_back(make_geometry(link.collisions, link.inertial));
  }
  return cached.links;
}

}  // namespace limber::sim
