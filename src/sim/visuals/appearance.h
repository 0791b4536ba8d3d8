// Appearance: properties of the view's lighting and surroundings (/visuals/look); rendering is elsewhere. [sim]
#pragma once

#include "properties/store.h"

namespace limber::sim {

class Appearance {
 public:
  static const PropertyTable& table();

  Appearance(Store& store, NodeId parent) : store_(store), id_(store.add(table(), parent, "look", this)) {}
  NodeId id() const { return id_; }

 private:
  Result<void> act_prefer(std::span<const double> args);

  Store& store_;
  NodeId id_;
};

}  // namespace limber::sim
