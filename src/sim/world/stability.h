// Stability check: limits for the motion of parts. The world restores the body of a part that exceeds them. [sim]
#pragma once

#include <string>

class btDispatcher;
class btRigidBody;

namespace limber {

class Body;
class Part;

/// Describes the instability of a part after an internal step of `h` s as a predicate for a message ("is faster than
/// …"), or returns null if it is stable. Rotation about a driven joint's axis or a principal axis isn't counted. [any,
/// while no thread writes]
const char* find_instability(const btRigidBody& part, double h);

/// Returns the likely cause of a part's instability and a remedy, as a clause for a message.
std::string likely_cause(const Body& body, const Part& part, const btDispatcher& contacts, int substeps);

}  // namespace limber
