// Steps from an MjcfFile to the importer's UrdfFile. Internal to the module: only src/model includes it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "model/mjcf/file.h"
#include "model/problems.h"
#include "model/urdf/file.h"
#include "model/urdf/mesh_loader.h"

namespace limber::model {

/// Loads the meshes of the geoms; removes geoms whose mesh can't be loaded. [any]
void load_meshes(MjcfFile& file, MeshLoader& loader);

/// Gives unnamed bodies and joints names, and makes all names unique. [any]
void complete_names(MjcfFile& file, Problems& problems);

/// Sets `MjcfBody::inertial` of all bodies from <inertial> or their geoms, as MuJoCo's compiler does. [any]
void set_masses(MjcfFile& file, const MjcfCompiler& compiler);

/// Adds the loops of the file, and reports those with a body that is not part of `out`. `link_of`: by body, its link in
/// `out`, or -1. `root`: the top-level body that `out` is made of; 0: the world with all of them. [any]
void convert_loops(const MjcfFile& file, const std::vector<int>& link_of, std::size_t root, UrdfFile& out,
                   Problems& problems);

/// The poses of all bodies in the world, with all joints at their home values. [any]
std::vector<Pose> home_poses(const MjcfFile& file);

/// Adds the tendons of the file, and reports those with a body that is not part of `out`. `link_of` as above. [any]
void convert_tendons(const MjcfFile& file, const std::vector<int>& link_of, std::size_t root, UrdfFile& out,
                     Problems& problems);

/// Returns the links and joints of the chosen top-level body (ImportOptions::root). The error, an unknown root, starts
/// with a line number and a colon. [any]
Result<UrdfFile> convert_mjcf(const MjcfFile& file, const std::string& root, Problems& problems);

}  // namespace limber::model
