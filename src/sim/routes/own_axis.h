// The own axis of vectors of joints and motors, for those who set or read a single number of them. [sim]
#pragma once

#include "properties/store.h"

namespace limber::sim {

/// Returns the index (0 to 2) of the own axis within a linear or angular property of a joint or motor; -1: the joint
/// has no own axis, the property is not along it, or the node is of another class.
int own_axis_index(const Store& store, NodeId node, const Property& property);

}  // namespace limber::sim
