// Shape: a named geometry of the scene, shared by the parts that use it. [sim]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/body_model.h"
#include "properties/store.h"

namespace limber::sim {

struct Geometry;

class Shape {
 public:
  static const PropertyTable& table();

  Shape(Store& store, NodeId group, std::string name, model::ShapeModel model);
  ~Shape();
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const { return store_.name(id_); }
  const model::ShapeModel& model() const { return model_; }

  /// Adds a child to a compound (else an error), placed in the compound's frame. Existing parts don't change.
  Result<void> add_child(const Shape& child, const Pose& origin);
  /// The shape's geometries in its own frame: the shape itself, or the children of a compound.
  std::vector<model::PlacedShape> placed() const;
  std::size_t child_count() const { return children_.size(); }
  /// Removes children from the end so that `count` remain: rolls back the additions of a guarded call that failed.
  void truncate_children(std::size_t count);
  const std::vector<model::PlacedShape>& children() const { return children_; }
  /// Takes over the geometry of another shape, possibly of another world. Existing parts don't change.
  void assign_geometry(const Shape& source);
  /// Sets the color that a model file gives a visual, if any, without marking the properties as explicitly set.
  void set_color(const model::PlacedShape& visual);
  /// The collision geometry of a part of this shape, with the mass spread over its volume. Built at first use.
  std::shared_ptr<const Geometry> geometry() const;

 private:
  void read_color(double* out) const;
  void write_color(const double* in);

  Store& store_;
  NodeId id_;
  model::ShapeModel model_;
  std::vector<model::PlacedShape> children_;
  mutable std::shared_ptr<const Geometry> geometry_;
};

/// Name of the shape of a link's visual: `<robot>.<link>` for the first, `<robot>.<link>.2` for the second, and so
/// on.
std::string visual_shape_name(const model::BodyModel& model, const model::LinkModel& link, std::size_t number);

/// Validates a shape's numbers. The error names the fault ("a sphere needs a radius of 1e-4 .. 1e4 m, not -1").
Result<void> check_shape(const model::ShapeModel& model);

}  // namespace limber::sim
