// Models that the user adds to a running scene. A model is one line of Lua that runs after the scene's file, in each
// run of the scene, so that takes, resets and reloads contain it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/body_model.h"

namespace limber::sim {
class World;
}  // namespace limber::sim

namespace limber::engine {

/// A model and the name and place of its body.
struct AddedModel {
  std::string path;     ///< Of the model file, absolute.
  std::string name;     ///< Of the body.
  Vec3 position{0};     ///< Of the root's link frame, world.
  bool servos = false;  ///< All motors hold their pose, although no actuator of the file drives them.
};

/// True if the scene shall set the motors of this model to servos: it has joints, and no actuator of the file drives
/// one. [any]
bool needs_servos(const model::BodyModel& model);

/// Chooses a name that is not in `names`, and a place where the model overlaps no body of the world: the nearest one to
/// the origin of a square spiral, on the floor if the model can move, else at its own height but not below the floor.
/// [sim]
AddedModel place_model(const sim::World& world, const std::string& path, const model::BodyModel& model,
                       const std::vector<std::string>& names);

/// Returns the line of Lua that loads it. `path`: the path to write. [any]
std::string lua_line(const AddedModel& model, const std::string& path);

}  // namespace limber::engine
