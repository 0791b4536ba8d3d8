// Loads meshes from STL and PLY (binary and ASCII), OBJ, Collada (DAE), glTF and MSH (MuJoCo) files.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/body_model.h"

namespace limber::model {

inline constexpr std::size_t kMaxMeshBytes = 128u << 20;
inline constexpr std::size_t kMaxMeshTriangles = 2'000'000;

class LookFiles;

enum class MeshFormat { stl, obj, dae, msh, ply, gltf, glb };
/// The format by the file name's extension, in any case; the error lists the supported formats. [any]
Result<MeshFormat> mesh_format_of(std::string_view path);

/// Parses a mesh, scales it, merges equal vertices, and computes its hull and mass properties. Coordinates are those of
/// the file (axes are not converted, except those of glTF, which has y up; DAE's unit and node transforms are applied)
/// times `scale`. A scale that mirrors also flips the winding. `files`: reads the material files and textures that it
/// names; null: they are not read. The error describes the fault and its fix, without the file's name. [any]
Result<std::shared_ptr<const MeshModel>> mesh_from_bytes(std::string_view bytes, MeshFormat format, const Vec3& scale,
                                                         const std::string& name, LookFiles* files = nullptr);

/// Loads a mesh from a file; the error starts with the file's path. [any]
Result<std::shared_ptr<const MeshModel>> load_mesh(const std::string& path, const Vec3& scale,
                                                   LookFiles* files = nullptr);

}  // namespace limber::model
