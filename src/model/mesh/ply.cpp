// PLY reader (Stanford polygon files), ASCII and binary: vertices with colors and texture coordinates, faces with
// colors.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "model/look/soup_look.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

struct PlyType {
  std::string_view name, other_name;
  std::size_t bytes;
  bool real, negative;  // else an integer, without sign
};
constexpr std::array<PlyType, 8> kPlyTypes{{{"char", "int8", 1, false, true},
                                            {"uchar", "uint8", 1, false, false},
                                            {"short", "int16", 2, false, true},
                                            {"ushort", "uint16", 2, false, false},
                                            {"int", "int32", 4, false, true},
                                            {"uint", "uint32", 4, false, false},
                                            {"float", "float32", 4, true, true},
                                            {"double", "float64", 8, true, true}}};

struct PlyProperty {
  std::string name;
  const PlyType* type = nullptr;
  const PlyType* count_type = nullptr;  // of a list; null: a single number
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::string texture;
  std::size_t end = 0;  // index of the first byte after it
  int lines = 0;
};

const PlyType* ply_type(std::string_view name) {
  const auto* const found = std::find_if(kPlyTypes.begin(), kPlyTypes.end(),
                                         [&](const PlyType& t) { return t.name == name || t.other_name == name; });
  return found == kPlyTypes.end() ? nullptr : found;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  MeshTokenizer tokens(line);
  for (std::string_view word = tokens.next(); !word.empty(); word = tokens.next()) out.push_back(word);
  return out;
}

using PlyWords = std::span<const std::string_view>;

// These read a line of the header. They return the error text, or empty on success.
std::string read_ply_format(PlyWords words, PlyHeader& header) {
  constexpr std::array<std::string_view, 3> kNames{"ascii", "binary_little_endian", "binary_big_endian"};
  const auto* const found = std::find(kNames.begin(), kNames.end(), words[1]);
  if (found == kNames.end()) return fmt::format("unknown format {}", quoted_word(words[1]));
  header.format = static_cast<PlyFormat>(found - kNames.begin());
  return {};
}

std::string read_ply_element(PlyWords words, PlyHeader& header) {
  const std::optional<std::int64_t> count = parse_integer(words[2]);
  if (!count || *count < 0) return fmt::format("{} is not a number of elements", quoted_word(words[2]));
  header.elements.push_back({std::string(words[1]), static_cast<std::size_t>(*count), {}});
  return {};
}

std::string read_ply_property(PlyWords words, PlyHeader& header) {
  constexpr std::size_t kMaxProperties = 64;
  const bool is_list = words.size() == 5 && words[1] == "list";
  if (header.elements.empty() || !(is_list || words.size() == 3)) return "a property can't be read";
  const PlyType* const type = ply_type(words[is_list ? 3 : 1]);
  const PlyType* const count_type = is_list ? ply_type(words[2]) : nullptr;
  if (type == nullptr || (is_list && (count_type == nullptr || count_type->real)))
    return fmt::format("unknown type of property {}", quoted_word(words.back()));
  std::vector<PlyProperty>& properties = header.elements.back().properties;
  properties.push_back({std::string(words.back()), type, count_type});
  return properties.size() > kMaxProperties ? fmt::format("more than {} properties", kMaxProperties) : std::string();
}

std::string read_ply_line(std::string_view line, PlyHeader& header) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.empty() || words[0] == "obj_info") return {};
  if (words[0] == "comment") {
    constexpr std::string_view kTexture = "TextureFile";
    if (words.size() > 2 && words[1] == kTexture)
      header.texture = trimmed(line.substr(line.find(kTexture) + kTexture.size()));
    return {};
  }
  if (words[0] == "format" && words.size() >= 2) return read_ply_format(words, header);
  if (words[0] == "element" && words.size() == 3) return read_ply_element(words, header);
  if (words[0] == "property") return read_ply_property(words, header);
  return fmt::format("unexpected {} in the header", quoted_word(words[0]));
}

Result<PlyHeader> read_ply_header(std::string_view bytes) {
  PlyHeader header;
  constexpr int kMaxLines = 1000;
  while (header.end < bytes.size() && header.lines < kMaxLines) {
    const std::size_t end = std::min(bytes.find('\n', header.end), bytes.size());
    std::string_view line = bytes.substr(header.end, end - header.end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    header.end = std::min(end + 1, bytes.size());
    header.lines++;
    if (line == "end_header") return header;
    if (header.lines == 1 && line != "ply") break;
    const std::string fault = header.lines == 1 ? std::string() : read_ply_line(line, header);
    if (!fault.empty()) return mesh_error(header.lines, fault);
  }
  return Error{"is not a PLY file, or its header is incomplete. Export it again."};
}

// The numbers after the header, one by one.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, const PlyHeader& header)
      : format_(header.format), data_(bytes.substr(header.end)), words_(data_, header.lines + 1) {}

  // Empty at the end of the file, and for words that are no finite numbers.
  std::optional<double> next(const PlyType& type) {
    if (format_ == PlyFormat::ascii) return parse_number(words_.next());
    if (position_ + type.bytes > data_.size()) return {};
    std::array<char, 8> raw{};
    for (std::size_t i = 0; i < type.bytes; ++i)
      raw[i] = data_[position_ + (format_ == PlyFormat::big_endian ? type.bytes - 1 - i : i)];
    position_ += type.bytes;
    const double value = decode(raw, type);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  }
  // The number of elements of this many numbers that can still follow.
  std::size_t capacity(const PlyElement& element) const {
    std::size_t bytes = 0;
    for (const PlyProperty& p : element.properties)
      bytes += format_ == PlyFormat::ascii ? 1 : p.count_type != nullptr ? p.count_type->bytes : p.type->bytes;
    return bytes == 0 ? 0 : data_.size() / bytes + 1;
  }
  Error error() const {
    if (format_ == PlyFormat::ascii) return mesh_error(words_.line(), "a number is missing or not finite");
    return Error{"ends too early, or has a number that is not finite. Export it again."};
  }

 private:
  static double decode(const std::array<char, 8>& raw, const PlyType& type) {
    static_assert(std::endian::native == std::endian::little);
    if (type.real && type.bytes == 8) return std::bit_cast<double>(raw);
    std::uint32_t bits = 0;
    std::memcpy(&bits, raw.data(), type.bytes);
    if (type.real) return static_cast<double>(std::bit_cast<float>(bits));
    if (!type.negative) return bits;
    const unsigned unused = 32 - 8 * static_cast<unsigned>(type.bytes);
    return static_cast<std::int32_t>(bits << unused) >> unused;
  }

  PlyFormat format_;
  std::string_view data_;
  MeshTokenizer words_;
  std::size_t position_ = 0;
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, PlyHeader header, SoupLook* look)
      : header_(std::move(header)), numbers_(bytes, header_), look_(look) {
    if (look_ != nullptr && !header_.texture.empty()) material_.image = header_.texture;
  }

  Result<MeshSoup> read() {
    for (const PlyElement& element : header_.elements) {
      if (element.count > numbers_.capacity(element)) return Error{"ends too early. Export it again."};
      if (element.count > 3 * kMaxMeshTriangles) return too_many_triangles();
      for (std::size_t i = 0; i < element.count; ++i) {
        if (Result<void> read = read_element(element); !read) return Error{read.error()};
      }
    }
    if (look_ != nullptr && (has_colors_ || !material_.image.empty())) {
      material_.name = "PLY";
      look_->paint(soup_.size(), look_->add(material_));
    }
    return std::move(soup_);
  }

 private:
  enum Field : std::size_t { x, y, z, red, green, blue, s, t, field_count };

  static std::size_t field_of(std::string_view name) {
    struct Name {
      std::string_view name;
      std::size_t field;
    };
    constexpr std::array<Name, 17> kNames{{{"x", x},
                                           {"y", y},
                                           {"z", z},
                                           {"red", red},
                                           {"green", green},
                                           {"blue", blue},
                                           {"diffuse_red", red},
                                           {"diffuse_green", green},
                                           {"diffuse_blue", blue},
                                           {"s", s},
                                           {"t", t},
                                           {"u", s},
                                           {"v", t},
                                           {"texture_u", s},
                                           {"texture_v", t},
                                           {"texture_s", s},
                                           {"texture_t", t}}};
    const auto* const found = std::find_if(kNames.begin(), kNames.end(), [&](const Name& n) { return n.name == name; });
    return found == kNames.end() ? field_count : found->field;
  }

  Result<void> read_element(const PlyElement& element) {
    fields_ = {};
    indices_.clear();
    texcoords_.clear();
    for (const PlyProperty& property : element.properties) {
      const bool read = property.count_type != nullptr ? read_list(property) : read_number(property);
      if (!read) return numbers_.error();
    }
    if (element.name == "vertex") return add_vertex();
    if (element.name == "face") return add_face(color_of(fields_[red], fields_[green], fields_[blue]));
    if (element.name == "tristrips")
      return Error{"has triangle strips, which are not supported. Export it with faces."};
    return {};
  }

  bool read_number(const PlyProperty& property) {
    const std::optional<double> value = numbers_.next(*property.type);
    if (!value) return false;
    const std::size_t field = field_of(property.name);
    if (field == field_count) return true;
    // colors are integers up to 255, or fractions
    const bool color = field == red || field == green || field == blue;
    fields_[field] = color && !property.type->real ? *value / 255 : *value;
    return true;
  }

  Result<void> add_vertex() {
    if (!fields_[x] || !fields_[y] || !fields_[z]) return Error{"has vertices without x, y and z. Export it again."};
    Vertex& vertex = vertices_.emplace_back();
    vertex.point = {*fields_[x], *fields_[y], *fields_[z]};
    if (fields_[s] && fields_[t]) vertex.texcoord = texcoord_of(*fields_[s], *fields_[t]);
    vertex.color = color_of(fields_[red], fields_[green], fields_[blue]);
    return {};
  }

  bool read_list(const PlyProperty& property) {
    const std::optional<double> count = numbers_.next(*property.count_type);
    if (!count || *count < 0) return false;
    const bool is_indices = property.name == "vertex_indices" || property.name == "vertex_index";
    for (double i = 0; i < *count; ++i) {
      const std::optional<double> value = numbers_.next(*property.type);
      if (!value) return false;
      if (is_indices) indices_.push_back(*value);
      if (property.name == "texcoord") texcoords_.push_back(*value);
    }
    return true;
  }

  // they start at the bottom left
  static TexCoord texcoord_of(double s, double t) {
    return {static_cast<float>(std::clamp(s, -1e4, 1e4)), static_cast<float>(std::clamp(1 - t, -1e4, 1e4))};
  }

  static std::optional<CornerColor> color_of(const std::optional<double>& r, const std::optional<double>& g,
                                             const std::optional<double>& b) {
    if (!r || !g || !b) return {};
    const auto byte = [](double channel) {
      return static_cast<std::uint8_t>(std::clamp(channel, 0.0, 1.0) * 255 + 0.5);
    };
    return CornerColor{byte(*r), byte(*g), byte(*b), 255};
  }

  Result<void> add_face(const std::optional<CornerColor>& face_color) {
    outline_.clear();
    for (const double index : indices_) {
      if (!(index >= 0 && index < static_cast<double>(vertices_.size())))
        return Error{fmt::format("has a face with vertex {:.0f}, but {} vertices before it. Export it again.", index,
                                 vertices_.size())};
      outline_.push_back(vertices_[static_cast<std::size_t>(index)].point);
    }
    corners_.clear();
    triangulator_.triangulate(outline_, corners_);
    for (const std::size_t i : corners_) {
      const std::size_t corner = soup_.size();
      soup_.push_back(outline_[i]);
      if (look_ == nullptr) continue;
      const Vertex& vertex = vertices_[static_cast<std::size_t>(indices_[i])];
      const std::optional<CornerColor> color = face_color ? face_color : vertex.color;
      if (color) look_->set_color(corner, *color);
      has_colors_ = has_colors_ || color.has_value();
      if (texcoords_.size() == 2 * indices_.size()) {
        look_->set_texcoord(corner, texcoord_of(texcoords_[2 * i], texcoords_[2 * i + 1]));
      } else if (vertex.texcoord) {
        look_->set_texcoord(corner, *vertex.texcoord);
      }
    }
    if (soup_.size() > 3 * kMaxMeshTriangles) return too_many_triangles();
    return {};
  }

  struct Vertex {
    Vec3 point{0};
    std::optional<TexCoord> texcoord;
    std::optional<CornerColor> color;
  };

  PlyHeader header_;
  PlyNumbers numbers_;
  SoupLook* look_;
  MeshMaterial material_;
  MeshSoup soup_;
  std::vector<Vertex> vertices_;
  bool has_colors_ = false;
  // of the current element
  std::array<std::optional<double>, field_count> fields_{};
  std::vector<double> indices_, texcoords_;
  std::vector<Vec3> outline_;
  std::vector<std::size_t> corners_;
  PolygonTriangulator triangulator_;
};

}  // namespace

Result<MeshSoup> soup_from_ply(std::string_view bytes, SoupLook* look) {
  Result<PlyHeader> header = read_ply_header(bytes);
  if (!header) return Error{header.error()};
  return PlyReader(bytes, std::move(*header), look).read();
}

}  // namespace limber::model
