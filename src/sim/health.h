// Health: what a part that moves stays below; beyond it the world puts its body back. [sim]
#pragma once

#include "sim/bullet.h"

namespace limber {

/// What is wrong with a part after an internal step, said of it; null: nothing. [any thread, while nobody writes]
const char* ailment(const btRigidBody& part);

}  // namespace limber
