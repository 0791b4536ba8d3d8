// Shape: a named geometry of the scene, shared by the parts that use it. [sim]
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/body_model.h"
#include "params/store.h"

namespace limber {

struct Geometry;

class Shape {
 public:
  static const Table& table();

  Shape(Store& store, NodeId group, std::string name, ShapeModel model);
  ~Shape();
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;

  NodeId id() const { return id_; }
  const std::string& name() const { return store_.name(id_); }
  const ShapeModel& model() const { return model_; }

  /// Adds a child to a compound (else an error), placed in the compound's frame. Parts made before are not changed.
  Result<void> add_child(const Shape& child, const Pose& origin);
  /// The shape's geometries in its own frame: itself, or a compound's children.
  std::vector<PlacedShape> placed() const;
  std::size_t child_count() const { return children_.size(); }
  /// Takes the last children away again: what a guarded call that failed had added.
  void keep_children(std::size_t count);
  const std::vector<PlacedShape>& children() const { return children_; }
  /// Takes the geometry of another shape, of another world perhaps. Parts made before are not changed.
  void become(const Shape& other);
  /// Takes the colour that a file gives a visual, if it gives one; nothing counts as said by that.
  void paint(const PlacedShape& visual);
  /// As a part of that shape collides, mass spread over its volume. Built at first use.
  std::shared_ptr<const Geometry> geometry() const;

 private:
  Store& store_;
  NodeId id_;
  ShapeModel model_;
  std::vector<PlacedShape> children_;
  mutable std::shared_ptr<const Geometry> geometry_;
};

/// What the shape of a link's visual is called: `<robot>.<link>`, a second `<robot>.<link>.2`, and so on.
std::string visual_shape_name(const BodyModel& model, const LinkModel& link, std::size_t number);

/// What is wrong with a shape's numbers ("a sphere needs a radius of 1e-4 .. 1e4 m, not -1"), or success.
Result<void> check_shape(const ShapeModel& model);

}  // namespace limber
