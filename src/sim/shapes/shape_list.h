// ShapeList: the shapes of a world, and the collision geometries of its models. [sim]
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sim/shapes/shape.h"
#include "sim/world/object_list.h"

namespace limber::sim {

class WorldTransaction;

class ShapeList {
 public:
  ShapeList(Store& store, NodeId parent, WorldTransaction& transaction)
      : store_(store), transaction_(transaction), shapes_(store, store.add_group(parent, "shape")) {}

  std::span<const std::unique_ptr<Shape>> list() const { return shapes_.list(); }
  Shape* find(std::string_view name) const { return shapes_.find(name); }
  /// Errors: the name is taken or can't be printed, a number is out of range.
  Result<Shape*> add(std::string name, model::ShapeModel model);
  /// Adds a shape with the visual's color for each visual of the model (visual_shape_name). Shapes that exist already
  /// are left unchanged: all bodies of the model share them.
  void add_visuals(const model::BodyModel& model);
  void remove(Shape& shape);
  void move_to_front(const std::vector<Shape*>& first) { shapes_.move_to_front(first); }
  /// Removes all shapes and geometries.
  void clear();
  /// Returns the shape of this list that has the same name as `shape` of the other store, or a null id.
  NodeId matching(const Store& other, NodeId shape) const;

  /// One geometry per link, built once per model and shared by all its bodies.
  const std::vector<std::shared_ptr<const Geometry>>& geometries_of(
      const std::shared_ptr<const model::BodyModel>& model);

 private:
  struct ModelGeometry {
    std::shared_ptr<const model::BodyModel> model;  // keeps the map key's address from being reused
    std::vector<std::shared_ptr<const Geometry>> links;
  };

  Store& store_;
  WorldTransaction& transaction_;
  ObjectList<Shape> shapes_;
  std::unordered_map<const model::BodyModel*, ModelGeometry> geometries_;
};

}  // namespace limber::sim
