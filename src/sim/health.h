// Health: bounds that a moving part stays within; beyond them the world restores its body. [sim]
#pragma once

#include <string>

#include "sim/bullet.h"

namespace limber {

class Body;
class Part;

/// What is wrong with a part after an internal step of `h` s, as a predicate for a message; null: nothing. Rotation
/// about a driven joint's axis or a principal axis is not counted. [any thread, while nobody writes]
const char* ailment(const btRigidBody& part, double h);

/// The likely cause of an instability of a part, and what to try, as a clause for a message.
std::string likely_cause(const Body& body, const Part& part, const btDispatcher& contacts, int substeps);

}  // namespace limber
