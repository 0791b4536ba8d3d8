// Shared by the readers of mesh files: triangle soups, a tokenizer with line numbers, error texts, and polygon
// triangulation. Internal to the module: only mesh_*.cpp includes it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/vec.h"

namespace limber::model {

/// Triangles without shared vertices: three corners each, counter-clockwise seen from outside.
using MeshSoup = std::vector<Vec3>;

class SoupLook;

/// The object of a file that each triangle belongs to, by number, in the order of first use. Empty if the format has no
/// objects, or if nothing reads them.
using SoupObjects = std::vector<std::uint32_t>;

/// Each reads the bytes of one file, in linear time and memory. The result has finite coordinates and at most
/// kMaxMeshTriangles triangles. Errors give the line (of text formats) and the fix. `look`: receives the colors; null:
/// they are not read. `objects`: receives the objects: groups (o and g) of OBJ, primitives of each node of glTF. [any]
Result<MeshSoup> soup_from_stl(std::string_view bytes, SoupLook* look = nullptr);
Result<MeshSoup> soup_from_obj(std::string_view bytes, SoupLook* look = nullptr, SoupObjects* objects = nullptr);
/// Reads the scene of a glTF 2.0 file (text or GLB), rotated from y up to z up.
Result<MeshSoup> soup_from_gltf(std::string_view bytes, SoupLook* look = nullptr, SoupObjects* objects = nullptr);
Result<MeshSoup> soup_from_ply(std::string_view bytes, SoupLook* look = nullptr);
Result<MeshSoup> soup_from_msh(std::string_view bytes);
/// Reads the active scene, converted to meters by the file's unit; axes are not converted. Skins and morphs use their
/// undeformed geometry; holes of polygons are ignored. Errors for <skew>, instances of missing elements, and files
/// larger than 32 MB. [any]
Result<MeshSoup> soup_from_collada(std::string_view bytes, SoupLook* look = nullptr);

/// An error with its line and a general fix: "line 3: <text>. Export it again, or as binary STL." [any]
Error mesh_error(int line, std::string_view text);
/// The error for more than kMaxMeshTriangles triangles. [any]
Error too_many_triangles();
/// A word of a file for an error text: printable, in quotes, shortened if it is long. [any]
std::string quoted_word(std::string_view word);

/// Parses a word that is an integer, with or without a sign; empty if it is not one. [any]
std::optional<std::int64_t> parse_integer(std::string_view word);

/// Splits a text into words at white space and counts lines, which may end with LF, CR or CR LF.
class MeshTokenizer {
 public:
  explicit MeshTokenizer(std::string_view text, int first_line = 1) : text_(text), current_line_(first_line) {}

  /// The next word; empty at the end.
  std::string_view next();
  /// The line of the last word.
  int line() const { return line_; }
  /// True if nothing follows the last word.
  bool at_end() const { return position_ == text_.size(); }
  /// Skips the rest of the last word's line.
  void skip_line();

 private:
  void advance();

  std::string_view text_;
  std::size_t position_ = 0;
  int current_line_;  // line of the character at position_
  int line_ = 1;      // line of the last word
};

/// Triangulates polygons: convex ones as fans, others by ear clipping. The steps are limited per instance (one file),
/// so that a hostile file takes at most about a second; after that, the rest of a polygon becomes a fan.
class PolygonTriangulator {
 public:
  /// Appends the triangles of a polygon to `out`; none for fewer than three corners.
  void triangulate(std::span<const Vec3> corners, MeshSoup& out);
  /// Appends the indices of the triangles' corners among those of the polygon.
  void triangulate(std::span<const Vec3> corners, std::vector<std::size_t>& out);

 private:
  void clip_ears(std::span<const Vec3> corners, const Vec3& normal, std::vector<std::size_t>& out);

  std::uint64_t steps_left_ = 100'000'000;
  std::vector<std::size_t> indices_;  // scratch
};

}  // namespace limber::model
