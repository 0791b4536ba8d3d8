// The own axis of vectors of joints and motors.
#include "sim/routes/own_axis.h"

#include "sim/world/joint.h"
#include "sim/world/motor.h"

namespace limber::sim {

int own_axis_index(const Store& store, NodeId node, const Property& property) {
  const PropertyTable* table = &store.table(node);
  int own_axis = -1;
  if (table == &Joint::table()) own_axis = static_cast<const Joint*>(store.object(node))->own_axis();
  if (table == &Motor::table()) own_axis = static_cast<const Motor*>(store.object(node))->joint().own_axis();
  if (own_axis < 0) return -1;
  const bool angular = property.name.find("angular") != std::string::npos;
  return (own_axis >= 3) == angular ? own_axis % 3 : -1;
}

}  // namespace limber::sim
