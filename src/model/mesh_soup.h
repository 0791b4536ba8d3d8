// What the readers of mesh files share: the triangles they give, the words of a text with their lines, and polygons
// cut into triangles. Part of the room's inside: only mesh_*.cpp includes it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/vec.h"

namespace limber {

/// Loose triangles as a file has them: three corners each, counter-clockwise seen from outside.
using MeshSoup = std::vector<Vec3>;

/// Each reads the whole of one file's bytes in time and memory that grow with their number. Coordinates are finite,
/// triangles at most kMostMeshTriangles. The error names the line of a text, and the cure. [any]
Result<MeshSoup> soup_from_stl(std::string_view bytes);
Result<MeshSoup> soup_from_obj(std::string_view bytes);
/// The scene that is shown, in metres by its unit, no axis turned. Skins and morphs are taken as they were modelled, of
/// polygons with holes the outline; a skew, an instance of nothing, and more than 32 MB are refused.
Result<MeshSoup> soup_from_collada(std::string_view bytes);

/// "line 3: 'x' is no finite number. Export …": what stands at fault, with the cure that fits every text. [any]
Error mesh_fault(int line, std::string_view text);
/// What is said of too many triangles. [any]
Error too_many_triangles();
/// A word of a file as an error shows it: printable, in quotes, cut when it is long. [any]
std::string quoted_word(std::string_view word);

/// A whole number that fills the word, with or without a sign; else nothing. [any]
std::optional<std::int64_t> parse_whole(std::string_view word);

/// The words of a text between blanks. Lines end with LF, CR or both.
class MeshWords {
 public:
  explicit MeshWords(std::string_view text, int first_line = 1) : text_(text), here_(first_line) {}

  /// The next word; empty at the end.
  std::string_view next();
  /// The line of the word given last.
  int line() const { return line_; }
  /// Whether nothing follows the word given last.
  bool at_end() const { return at_ == text_.size(); }
  /// Goes on behind the end of this line.
  void skip_line();

 private:
  void step();

  std::string_view text_;
  std::size_t at_ = 0;
  int here_;      // the line at at_
  int line_ = 1;  // that of the last word
};

/// Cuts polygons into triangles. Convex ones become fans; of others the ears are clipped, as long as the steps for one
/// file last, so that hostile outlines cost no more than a second.
class PolygonCutter {
 public:
  /// Appends the triangles of an outline to `out`; fewer than three corners give none.
  void cut(std::span<const Vec3> corners, MeshSoup& out);

 private:
  void clip_ears(std::span<const Vec3> corners, const Vec3& normal, MeshSoup& out);

  std::uint64_t steps_left_ = 100'000'000;
};

}  // namespace limber
