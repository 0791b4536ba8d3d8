// Wavefront OBJ reader: vertices and faces only; groups, normals, texture coordinates, curves and materials are
// ignored.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"

namespace limber::model {

namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// Iterates over the 'v' and 'f' lines of an OBJ file; lines continued with a backslash are read as one.
class ObjLines {
 public:
  explicit ObjLines(std::string_view text) : text_(text) {}

  /// Finds the next vertex or face; false at the end.
  bool next() {
    while (position_ < text_.size()) {
      line_ = current_line_;
      const std::size_t from = std::min(text_.find_first_not_of(" \t", position_), text_.size());
      position_ = from;
      const bool wanted = from + 1 < text_.size() && (text_[from] == 'v' || text_[from] == 'f') &&
                          (text_[from + 1] == ' ' || text_[from + 1] == '\t');
      advance_to_line_end(wanted);
      const std::string_view whole = text_.substr(from, position_ - from);
      advance_line();
      if (!wanted) continue;
      kind_ = whole[0];
      rest_ = whole.substr(1, whole.find('#') - 1);
      return true;
    }
    return false;
  }
  char kind() const { return kind_; }
  int line() const { return line_; }
  void rewind() { position_ = 0, current_line_ = 1; }

  /// The next word of this line; empty at its end.
  std::string_view word() {
    // a line continuation separates words like a blank
    constexpr std::string_view kBlank = " \t\v\f\\\r\n";
    const std::size_t from = std::min(rest_.find_first_not_of(kBlank), rest_.size());
    const std::size_t to = std::min(rest_.find_first_of(kBlank, from), rest_.size());
    const std::string_view word = rest_.substr(from, to - from);
    rest_.remove_prefix(to);
    return word;
  }

 private:
  /// Advances to the end of the line, or of its last continuation line.
  void advance_to_line_end(bool may_continue) {
    while (true) {
      while (position_ < text_.size() && !is_line_end(text_[position_])) ++position_;
      if (!may_continue || position_ >= text_.size() || position_ == 0 || text_[position_ - 1] != '\\') return;
      advance_line();
    }
  }
  void advance_line() {
    if (position_ >= text_.size()) return;
    position_ += text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n' ? 2 : 1;
    ++current_line_;
  }

  std::string_view text_;
  std::string_view rest_;
  std::size_t position_ = 0;
  int current_line_ = 1;
  int line_ = 1;
  char kind_ = ' ';
};

/// Reads x y z, optionally followed by a weight or a color. Returns the error text, or empty on success.
std::string read_vertex(ObjLines& lines, Vec3& v) {
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = lines.word();
    const std::optional<double> number = parse_number(word);
    if (word.empty()) return "a vertex has fewer than three coordinates";
    if (!number) return fmt::format("{} is not a finite number", quoted_word(word));
    v[i] = *number;
  }
  const std::string_view fourth = lines.word();
  if (fourth.empty() || !lines.word().empty()) return {};
  const double weight = parse_number(fourth).value_or(0);
  if (weight == 0) return fmt::format("{} is not a weight of a vertex", quoted_word(fourth));
  v /= weight;
  return is_finite(v) ? std::string() : "a vertex is not finite";
}

/// Reads corners written as v, v/vt, v//vn or v/vt/vn. Returns the error text, or empty on success.
std::string read_face(ObjLines& lines, const std::vector<Vec3>& vertices, std::size_t vertices_before,
                      std::vector<Vec3>& outline) {
  outline.clear();
  for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
    const std::optional<std::int64_t> index = parse_integer(word.substr(0, word.find('/')));
    if (!index || word.find_first_not_of("+-/0123456789") != std::string_view::npos) {
      return fmt::format("{} is not a corner of a face", quoted_word(word));
    }
    // 1-based, or negative: relative to the last vertex before the face
    const std::int64_t at = *index < 0 ? static_cast<std::int64_t>(vertices_before) + *index : *index - 1;
    if (at < 0 || at >= static_cast<std::int64_t>(vertices.size())) {
      return fmt::format("a face uses vertex {}, but there are {}", *index,
                         *index < 0 ? vertices_before : vertices.size());
    }
    outline.push_back(vertices[static_cast<std::size_t>(at)]);
  }
  return {};
}

}  // namespace

Result<MeshSoup> soup_from_obj(std::string_view bytes) {
  ObjLines lines(bytes);
  std::vector<Vec3> vertices;
  while (lines.next()) {
    if (lines.kind() != 'v') continue;
    vertices.emplace_back(0);
    const std::string fault = read_vertex(lines, vertices.back());
    if (!fault.empty()) return mesh_error(lines.line(), fault);
    if (vertices.size() > 3 * kMaxMeshTriangles) return too_many_triangles();
  }
  // second pass, because a face may refer to vertices further down
  lines.rewind();
  MeshSoup soup;
  PolygonTriangulator triangulator;
  std::vector<Vec3> outline;
  std::size_t vertices_before = 0;
  while (lines.next()) {
    if (lines.kind() == 'v') {
      ++vertices_before;
      continue;
    }
    const std::string fault = read_face(lines, vertices, vertices_before, outline);
    if (!fault.empty()) return mesh_error(lines.line(), fault);
    if (soup.size() / 3 + outline.size() > kMaxMeshTriangles + 2) return too_many_triangles();
    triangulator.triangulate(outline, soup);
  }
  return soup;
}

}  // namespace limber::model
