// Meshes from STL (binary and ASCII), OBJ and DAE files, through one loader.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"
#include "model/body_model.h"

namespace limber {

inline constexpr std::size_t kMostMeshBytes = 128u << 20;
inline constexpr std::size_t kMostMeshTriangles = 2'000'000;

enum class MeshFormat { stl, obj, dae };
/// By the file name's ending, whatever its case; the error names the three that are read. [any]
Result<MeshFormat> mesh_format_of(std::string_view path);

/// Vertices in the file's raw coordinates (no axis is turned, DAE's unit and node transforms count) times `scale`,
/// merged, finite, with hull and mass properties. Mirrored when the scale is. The error names the fault and the cure,
/// not the file. [any]
Result<std::shared_ptr<const MeshModel>> mesh_from_bytes(std::string_view bytes, MeshFormat format, const Vec3& scale,
                                                         const std::string& name);

/// The same from a file; the error names it. [any]
Result<std::shared_ptr<const MeshModel>> load_mesh(const std::string& path, const Vec3& scale);

}  // namespace limber
