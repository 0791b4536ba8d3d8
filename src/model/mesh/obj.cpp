// Wavefront OBJ reader: vertices, faces, texture coordinates, materials and objects; normals and curves are ignored.
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "model/look/mtl.h"
#include "model/look/soup_look.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }

enum class ObjLine : std::uint8_t { vertex, texcoord, face, use_material, material_file, object, group };
constexpr std::array<std::string_view, 7> kObjWords{"v", "vt", "f", "usemtl", "mtllib", "o", "g"};

/// Iterates over the lines of an OBJ file that start with one of kObjWords; lines continued with a backslash are read
/// as one.
class ObjLines {
 public:
  explicit ObjLines(std::string_view text) : text_(text) {}

  /// Finds the next line; false at the end.
  bool next() {
    while (position_ < text_.size()) {
      line_ = current_line_;
      const std::size_t from = std::min(text_.find_first_not_of(" \t", position_), text_.size());
      position_ = from;
      const std::string_view start = text_.substr(from, 8);
      const std::string_view word = start.substr(0, start.find_first_of(" \t"));
      const auto* const known = std::find(kObjWords.begin(), kObjWords.end(), word);
      const bool wanted = known != kObjWords.end() && word.size() < start.size();
      advance_to_line_end(wanted);
      const std::string_view whole = text_.substr(from, position_ - from);
      advance_line();
      if (!wanted) continue;
      kind_ = static_cast<ObjLine>(known - kObjWords.begin());
      const bool has_names = kind_ >= ObjLine::use_material;
      rest_ = whole.substr(word.size(), has_names ? std::string_view::npos : whole.find('#') - word.size());
      return true;
    }
    return false;
  }
  ObjLine kind() const { return kind_; }
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
  /// The rest of this line.
  std::string_view rest() const { return trimmed(rest_); }

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
  ObjLine kind_ = ObjLine::vertex;
};

/// Reads x y z, optionally followed by a weight or a color. Returns the error text, or empty on success.
std::string read_vertex(ObjLines& lines, Vec3& v, std::optional<CornerColor>& color) {
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = lines.word();
    const std::optional<double> number = parse_number(word);
    if (word.empty()) return "a vertex has fewer than three coordinates";
    if (!number) return fmt::format("{} is not a finite number", quoted_word(word));
    v[i] = *number;
  }
  const std::string_view fourth = lines.word();
  if (fourth.empty()) return {};
  const std::optional<double> number = parse_number(fourth);
  if (const std::string_view fifth = lines.word(); !fifth.empty()) {
    const std::optional<double> green = parse_number(fifth), blue = parse_number(lines.word());
    if (!number || !green || !blue) return {};
    const auto byte = [](double channel) {
      return static_cast<std::uint8_t>(std::clamp(channel, 0.0, 1.0) * 255 + 0.5);
    };
    color = CornerColor{byte(*number), byte(*green), byte(*blue), 255};
    return {};
  }
  const double weight = number.value_or(0);
  if (weight == 0) return fmt::format("{} is not a weight of a vertex", quoted_word(fourth));
  v /= weight;
  return is_finite(v) ? std::string() : "a vertex is not finite";
}

/// Texture coordinates start at the bottom left in OBJ files. Unreadable ones are 0.
TexCoord read_texcoord(ObjLines& lines) {
  constexpr double kMax = 1e4;
  std::array<double, 2> read{};
  for (double& number : read) number = std::clamp(parse_number(lines.word()).value_or(0), -kMax, kMax);
  return {static_cast<float>(read[0]), static_cast<float>(1 - read[1])};
}

/// Reads an OBJ file in two passes, because a face may refer to vertices further down.
class ObjReader {
 public:
  ObjReader(std::string_view bytes, SoupLook* look, SoupObjects* objects)
      : lines_(bytes), look_(look), objects_(objects) {}

  Result<MeshSoup> read() {
    if (Result<void> points = read_points(); !points) return Error{points.error()};
    lines_.rewind();
    if (Result<void> faces = read_faces(); !faces) return Error{faces.error()};
    return std::move(soup_);
  }

 private:
  static constexpr std::size_t kNoTexcoord = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t kMaxObjects = 10'000;  // further ones belong to the last
  static constexpr std::size_t kMaxObjectName = 200;  // compared bytes

  Result<void> read_points() {
    while (lines_.next()) {
      if (lines_.kind() == ObjLine::vertex) {
        vertices_.emplace_back(0);
        std::optional<CornerColor> color;
        const std::string fault = read_vertex(lines_, vertices_.back(), color);
        if (!fault.empty()) return mesh_error(lines_.line(), fault);
        if (vertices_.size() > 3 * kMaxMeshTriangles) return too_many_triangles();
        if (color) colors_.resize(vertices_.size(), {255, 255, 255, 255});
        if (color) colors_.back() = *color;
      } else if (look_ != nullptr && lines_.kind() == ObjLine::texcoord) {
        texcoords_.push_back(read_texcoord(lines_));
        if (texcoords_.size() > 3 * kMaxMeshTriangles) return too_many_triangles();
      } else if (look_ != nullptr && lines_.kind() == ObjLine::material_file) {
        read_materials(std::string(lines_.rest()));
      }
    }
    return {};
  }

  void read_materials(const std::string& name) {
    if (look_->files() == nullptr || material_files_++ >= kMaxMaterialFiles) return;
    const Result<std::string> file = look_->files()->read(name, ".mtl", kMaxMaterialFileBytes);
    if (file) return read_mtl(*file, *look_, materials_);
    const auto [text, fix] = split_fix(file.error(), "Fix the file.");
    look_->report(Severity::warning, "material file", fmt::format("material file {}; drawn without its colors", text),
                  fix);
    lacks_materials_ = true;
  }

  Result<void> read_faces() {
    while (lines_.next()) {
      if (lines_.kind() == ObjLine::vertex) {
        ++vertices_before_;
      } else if (lines_.kind() == ObjLine::texcoord) {
        ++texcoords_before_;
      } else if (lines_.kind() == ObjLine::use_material) {
        use_material(lines_.rest());
      } else if (lines_.kind() == ObjLine::object || lines_.kind() == ObjLine::group) {
        use_object(lines_.kind(), lines_.rest());
      } else if (lines_.kind() == ObjLine::face) {
        const std::string fault = read_face();
        if (!fault.empty()) return mesh_error(lines_.line(), fault);
        if (soup_.size() / 3 + outline_.size() > kMaxMeshTriangles + 2) return too_many_triangles();
        add_face();
      }
    }
    return {};
  }

  void use_material(std::string_view name) {
    if (look_ == nullptr) return;
    const auto found = materials_.find(name);
    material_ = found == materials_.end() ? SoupLook::kNoMaterial : found->second;
    if (found != materials_.end() || lacks_materials_ || materials_.empty()) return;
    look_->report(Severity::warning, "material",
                  fmt::format("material '{}' not found in its material file; drawn white", printable(name)),
                  "Export the mesh again.");
  }

  /// Faces of the same object and group belong together, also if others are between them.
  void use_object(ObjLine kind, std::string_view name) {
    if (objects_ == nullptr || object_numbers_.size() >= kMaxObjects) return;
    if (kind == ObjLine::object) object_name_ = name.substr(0, kMaxObjectName), group_name_.clear();
    if (kind == ObjLine::group) group_name_ = name.substr(0, kMaxObjectName);
    const auto next = static_cast<std::uint32_t>(object_numbers_.size());
    object_ = object_numbers_.try_emplace({object_name_, group_name_}, next).first->second;
  }

  /// Reads corners written as v, v/vt, v//vn or v/vt/vn. Returns the error text, or empty on success.
  std::string read_face() {
    outline_.clear();
    corner_vertices_.clear();
    corner_texcoords_.clear();
    for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) {
      const std::size_t slash = word.find('/');
      const std::optional<std::int64_t> index = parse_integer(word.substr(0, slash));
      if (!index || word.find_first_not_of("+-/0123456789") != std::string_view::npos) {
        return fmt::format("{} is not a corner of a face", quoted_word(word));
      }
      // 1-based, or negative: relative to the last vertex before the face
      const std::int64_t at = *index < 0 ? static_cast<std::int64_t>(vertices_before_) + *index : *index - 1;
      if (at < 0 || at >= static_cast<std::int64_t>(vertices_.size())) {
        return fmt::format("a face uses vertex {}, but there are {}", *index,
                           *index < 0 ? vertices_before_ : vertices_.size());
      }
      outline_.push_back(vertices_[static_cast<std::size_t>(at)]);
      corner_vertices_.push_back(static_cast<std::size_t>(at));
      corner_texcoords_.push_back(slash == std::string_view::npos ? kNoTexcoord
                                                                  : texcoord_index(word.substr(slash + 1)));
    }
    return {};
  }

  std::size_t texcoord_index(std::string_view word) const {
    const std::optional<std::int64_t> index = parse_integer(word.substr(0, word.find('/')));
    if (!index) return kNoTexcoord;
    const std::int64_t at = *index < 0 ? static_cast<std::int64_t>(texcoords_before_) + *index : *index - 1;
    return at < 0 || at >= static_cast<std::int64_t>(texcoords_.size()) ? kNoTexcoord : static_cast<std::size_t>(at);
  }

  void add_face() {
    indices_.clear();
    triangulator_.triangulate(outline_, indices_);
    for (const std::size_t i : indices_) {
      const std::size_t corner = soup_.size();
      soup_.push_back(outline_[i]);
      if (look_ == nullptr) continue;
      if (corner_texcoords_[i] != kNoTexcoord) look_->set_texcoord(corner, texcoords_[corner_texcoords_[i]]);
      if (corner_vertices_[i] < colors_.size()) look_->set_color(corner, colors_[corner_vertices_[i]]);
    }
    if (look_ != nullptr) look_->paint(soup_.size(), material_);
    if (objects_ != nullptr) objects_->resize(soup_.size() / 3, object_);
  }

  ObjLines lines_;
  SoupLook* look_;
  SoupObjects* objects_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> object_numbers_{{{}, 0}};  // by object and group
  std::string object_name_, group_name_;
  std::uint32_t object_ = 0;
  MeshSoup soup_;
  std::vector<Vec3> vertices_;
  std::vector<CornerColor> colors_;  // of the first vertices; the others are white
  std::vector<TexCoord> texcoords_;
  std::map<std::string, std::uint32_t, std::less<>> materials_;
  std::uint32_t material_ = SoupLook::kNoMaterial;
  std::size_t material_files_ = 0;
  bool lacks_materials_ = false;
  std::size_t vertices_before_ = 0, texcoords_before_ = 0;
  // of the current face
  std::vector<Vec3> outline_;
  std::vector<std::size_t> corner_vertices_, corner_texcoords_, indices_;
  PolygonTriangulator triangulator_;
};

}  // namespace

Result<MeshSoup> soup_from_obj(std::string_view bytes, SoupLook* look, SoupObjects* objects) {
  return ObjReader(bytes, look, objects).read();
}

}  // namespace limber::model
