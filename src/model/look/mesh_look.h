// MeshLook: the colors and textures that a mesh file gives its triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "model/body_model.h"
#include "model/look/image.h"

namespace limber::model {

/// A material of a mesh file. Colors are sRGB-encoded, 0..1, as these files and their viewers use them.
struct MeshMaterial {
  std::string name;
  Vec3 color{1};      ///< In diffuse and ambient light; multiplied by the texture and the corners' colors.
  Vec3 emission{0};   ///< Light that it emits, added to the reflected light.
  double alpha = 1;   ///< 1: opaque.
  std::string image;  ///< Name of the texture's file, as written; empty: none.
  std::shared_ptr<const Image> texture;  ///< Null: none, or not loaded (reported).
};

using TexCoord = std::array<float, 2>;            ///< 0 0: top left of the image, 1 1: bottom right; repeats beyond.
using CornerColor = std::array<std::uint8_t, 4>;  ///< Red, green, blue, alpha; sRGB-encoded.

/// In the order of the mesh's triangles and their corners.
struct MeshLook {
  std::vector<MeshMaterial> materials;            ///< Empty: the file has no colors.
  std::vector<std::uint32_t> triangle_materials;  ///< Index of each triangle's material.
  std::vector<TexCoord> texcoords;                ///< Three per triangle; empty: none.
  std::vector<CornerColor> colors;                ///< Three per triangle, multiplied; empty: none.
  std::vector<Problem> problems;                  ///< What is not drawn; without the mesh's name.
  /// Other files that the mesh file names, with their hash_bytes(); 0: not found or not readable.
  std::vector<std::pair<std::string, std::uint64_t>> files;
};

/// The materials that a shape of a link is drawn in: those of its mesh, or the one that its color and texture make.
/// [any]
std::vector<MeshMaterial> drawn_materials(const PlacedShape& shape);
/// True if both are null or have the same file content. [any]
bool same_image(const std::shared_ptr<const Image>& a, const std::shared_ptr<const Image>& b);
/// True if two meshes with the same triangles have the same colors and textures. [any]
bool same_look(const MeshModel& a, const MeshModel& b);
/// True if the mesh has colors or textures of its own. [any]
inline bool has_colors(const MeshModel& mesh) { return mesh.look != nullptr && !mesh.look->materials.empty(); }

}  // namespace limber::model
