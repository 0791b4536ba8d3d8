// Reads Wavefront OBJ: vertices and faces; groups, normals, texture points, curves and materials are left out.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh_load.h"
#include "model/mesh_soup.h"

namespace limber {

namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// The lines of an OBJ file that say 'v' or 'f', those joined by a backslash as one.
class ObjLines {
 public:
  explicit ObjLines(std::string_view text) : text_(text) {}

  /// Finds the next vertex or face; false at the end.
  bool next() {
    while (at_ < text_.size()) {
      line_ = here_;
      const std::size_t from = std::min(text_.find_first_not_of(" \t", at_), text_.size());
      at_ = from;
      const bool wanted = from + 1 < text_.size() && (text_[from] == 'v' || text_[from] == 'f') &&
                          (text_[from + 1] == ' ' || text_[from + 1] == '\t');
      find_end(wanted);
      const std::string_view whole = text_.substr(from, at_ - from);
      end_line();
      if (!wanted) continue;
      kind_ = whole[0];
      rest_ = whole.substr(1, whole.find('#') - 1);
      return true;
    }
    return false;
  }
  char kind() const { return kind_; }
  int line() const { return line_; }
  void rewind() { at_ = 0, here_ = 1; }

  /// The next word of this line; empty at its end.
  std::string_view word() {
    // what joins two lines is as good as a blank
    constexpr std::string_view kBlank = " \t\v\f\\\r\n";
    const std::size_t from = std::min(rest_.find_first_not_of(kBlank), rest_.size());
    const std::size_t to = std::min(rest_.find_first_of(kBlank, from), rest_.size());
    const std::string_view word = rest_.substr(from, to - from);
    rest_.remove_prefix(to);
    return word;
  }

 private:
  /// To the line's end, or that of the last one joined to it.
  void find_end(bool may_join) {
    while (true) {
      while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
      if (!may_join || at_ >= text_.size() || at_ == 0 || text_[at_ - 1] != '\\') return;
      end_line();
    }
  }
  void end_line() {
    if (at_ >= text_.size()) return;
    at_ += text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n' ? 2 : 1;
    ++here_;
  }

  std::string_view text_;
  std::string_view rest_;
  std::size_t at_ = 0;
  int here_ = 1;
  int line_ = 1;
  char kind_ = ' ';
};

/// x y z, then nothing, a weight, or a colour. The text of what is wrong, or nothing.
std::string read_vertex(ObjLines& lines, Vec3& v) {
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = lines.word();
    const std::optional<double> number = parse_number(word);
    if (word.empty()) return "a vertex has fewer than three coordinates";
    if (!number) return fmt::format("{} is no finite number", quoted_word(word));
    v[i] = *number;
  }
  const std::string_view fourth = lines.word();
  if (fourth.empty() || !lines.word().empty()) return {};
  const double weight = parse_number(fourth).value_or(0);
  if (weight == 0) return fmt::format("{} is no weight of a vertex", quoted_word(fourth));
  v /= weight;
  return is_finite(v) ? std::string() : "a vertex is not finite";
}

/// Corners as v, v/vt, v//vn or v/vt/vn. The text of what is wrong, or nothing.
std::string read_face(ObjLines& lines, const std::vector<Vec3>& vertices, std::size_t so_far,
                      std::vector<Vec3>& outline) {
  outline.clear();
  for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
    const std::optional<std::int64_t> index = parse_whole(word.substr(0, word.find('/')));
    if (!index || word.find_first_not_of("+-/0123456789") != std::string_view::npos) {
      return fmt::format("{} is no corner of a face", quoted_word(word));
    }
    // counted from 1, or back from the vertex before the face
    const std::int64_t at = *index < 0 ? static_cast<std::int64_t>(so_far) + *index : *index - 1;
    if (at < 0 || at >= static_cast<std::int64_t>(vertices.size())) {
      return fmt::format("a face wants vertex {}; there are {}", *index, *index < 0 ? so_far : vertices.size());
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
    if (!fault.empty()) return mesh_fault(lines.line(), fault);
    if (vertices.size() > 3 * kMostMeshTriangles) return too_many_triangles();
  }
  // a face may name vertices that come after it
  lines.rewind();
  MeshSoup soup;
  PolygonCutter cutter;
  std::vector<Vec3> outline;
  std::size_t so_far = 0;
  while (lines.next()) {
    if (lines.kind() == 'v') {
      ++so_far;
      continue;
    }
    const std::string fault = read_face(lines, vertices, so_far, outline);
    if (!fault.empty()) return mesh_fault(lines.line(), fault);
    if (soup.size() / 3 + outline.size() > kMostMeshTriangles + 2) return too_many_triangles();
    cutter.cut(outline, soup);
  }
  return soup;
}

}  // namespace limber
