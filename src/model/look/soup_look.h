// SoupLook: collects materials and texture coordinates while a mesh file is read, and the files that they name.
// Internal to the module: only src/model includes it.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "model/look/mesh_look.h"

namespace limber::model {

inline constexpr std::size_t kMaxMeshMaterials = 4096;          ///< Per mesh; further ones are white.
inline constexpr std::size_t kMaxMeshTextures = 64;             ///< Per mesh.
inline constexpr std::size_t kMaxTexturePixels = 64u << 20;     ///< Of all textures of a mesh.
inline constexpr std::size_t kMaxMaterialFileBytes = 8u << 20;  ///< Largest .mtl file.
inline constexpr std::size_t kMaxMaterialFiles = 16;            ///< .mtl files of a mesh.

/// Reads the files that a mesh file names: material files, buffers and images.
class LookFiles {
 public:
  LookFiles() = default;
  LookFiles(const LookFiles&) = delete;
  LookFiles& operator=(const LookFiles&) = delete;
  virtual ~LookFiles() = default;
  /// Finds and reads a file, whose name must end with `extension`. The error describes the fault and its fix, and
  /// starts with the quoted name.
  virtual Result<std::string> read(const std::string& name, std::string_view extension, std::size_t max_bytes) = 0;
  /// Finds and decodes an image.
  virtual Result<std::shared_ptr<const Image>> image(const std::string& name) = 0;
  /// All files that were looked up, with the hash of their bytes; 0: not found or not readable.
  virtual std::vector<std::pair<std::string, std::uint64_t>> used() const = 0;
  /// Names that differ from those of the files that were found in the case of letters.
  virtual std::vector<std::string> misspelled() const = 0;
};

class SoupLook {
 public:
  static constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

  /// `files`: null: no other file is read.
  explicit SoupLook(LookFiles* files) : files_(files) {}

  /// Adds a material and loads its texture, unless it is set already. Returns its index; kNoMaterial if there are too
  /// many.
  std::uint32_t add(MeshMaterial material);
  std::size_t material_count() const { return materials_.size(); }
  /// Gives the triangles from the last call's `corners` up to now that material.
  void paint(std::size_t corners, std::uint32_t material) { triangle_materials_.resize(corners / 3, material); }
  /// Adds texture coordinates for the next corner with number `corner`; corners in between have 0 0.
  void set_texcoord(std::size_t corner, const TexCoord& texcoord);
  void set_color(std::size_t corner, const CornerColor& color);

  /// Reports something that is not drawn, once per `kind`, a word: with the first text, and the number of further ones.
  void report(Severity severity, const char* kind, std::string text, std::string fix);
  LookFiles* files() const { return files_; }

  /// The look of a soup with this number of corners; null: the file has no colors, and nothing to report.
  std::shared_ptr<MeshLook> release(std::size_t corners);

 private:
  struct Report {
    Problem problem;
    std::size_t count = 0;
  };

  std::shared_ptr<const Image> load(const std::string& name);
  std::shared_ptr<const Image> within_limits(std::shared_ptr<const Image> image, const std::string& name);

  LookFiles* files_;
  std::vector<MeshMaterial> materials_;
  std::vector<std::uint32_t> triangle_materials_;
  std::vector<TexCoord> texcoords_;
  std::vector<CornerColor> colors_;
  std::map<std::string, Report> reports_;
  std::map<std::string, std::shared_ptr<const Image>> images_;  // by name
  std::size_t pixels_ = 0;
};

}  // namespace limber::model
