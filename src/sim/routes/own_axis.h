// The own axis of a joint in its vectors and in those of its motor: the element that a single number stands for. [sim]
#pragma once

#include "properties/store.h"

namespace limber::sim {

/// Returns the index (0 to 2) of the own axis within a linear or angular property of a joint or motor; -1: the joint
/// has no own axis, the property is not along it, or the node is of another class.
int own_axis_index(const Store& store, NodeId node, const Property& property);

}  // namespace limber::sim
