// STL reader: binary if the file's length matches its triangle count, otherwise ASCII.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/text.h"
#include "model/look/soup_look.h"
#include "model/mesh/load.h"
#include "model/mesh/triangles.h"

namespace limber::model {

namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

bool same_letter_ignore_case(char a, char b) {
  return (a >= 'A' && a <= 'Z' ? static_cast<char>(a + ('a' - 'A')) : a) == b;
}

/// Case-insensitive comparison; `word` must be lower case.
bool equals_ignore_case(std::string_view text, std::string_view word) {
  return text.size() == word.size() && std::equal(text.begin(), text.end(), word.begin(), same_letter_ignore_case);
}
bool contains_ignore_case(std::string_view text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(), same_letter_ignore_case) != text.end();
}

bool looks_ascii(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 512);
  const bool text = std::none_of(start.begin(), start.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < '\t' || code == 127 || (code > '\r' && code < ' ');
  });
  return text && equals_ignore_case(MeshTokenizer(start).next().substr(0, 5), "solid") &&
         contains_ignore_case(bytes, "facet") && contains_ignore_case(bytes, "vertex");
}

std::uint16_t facet_attribute(std::string_view bytes, std::uint32_t facet) {
  std::uint16_t value = 0;
  std::memcpy(&value, bytes.data() + kHeaderBytes + kFacetBytes * facet + kFacetBytes - 2, sizeof value);
  return value;
}

CornerColor color_of_15_bits(std::uint16_t bits, bool red_first) {
  const auto channel = [&](int shift) { return static_cast<std::uint8_t>(((bits >> shift & 31) * 255 + 15) / 31); };
  return {channel(red_first ? 0 : 10), channel(5), channel(red_first ? 10 : 0), 255};
}

/// Reads the colors of facets, in one of two conventions. Magics: "COLOR=" in the header with the color of facets whose
/// bit 15 is set; the others have 5 bits each of red, green and blue, from bit 0. VisCAM and SolidView: facets with bit
/// 15 set have 5 bits each of blue, green and red; the others have none.
void read_facet_colors(std::string_view bytes, std::uint32_t count, SoupLook& look) {
  constexpr std::uint16_t kFlag = 0x8000;
  constexpr std::string_view kColor = "COLOR=";
  const std::size_t found = bytes.substr(0, kHeaderBytes - 4).find(kColor);
  const bool magics = found != std::string_view::npos && found + kColor.size() + 4 <= kHeaderBytes - 4;
  std::uint16_t any = 0;
  for (std::uint32_t i = 0; i < count; ++i) any = static_cast<std::uint16_t>(any | facet_attribute(bytes, i));
  if (!magics && (any & kFlag) == 0) return;
  CornerColor common{255, 255, 255, 255};
  if (magics) std::memcpy(common.data(), bytes.data() + found + kColor.size(), 3);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint16_t bits = facet_attribute(bytes, i);
    // attributes that are all 0 were not written by Magics: only its header was
    const bool own = magics ? (bits & kFlag) == 0 && any != 0 : (bits & kFlag) != 0;
    const CornerColor color = own ? color_of_15_bits(bits, magics) : common;
    for (std::size_t k = 0; k < 3; ++k) look.set_color(3 * std::size_t{i} + k, color);
  }
  MeshMaterial material;
  material.name = "facet colors";
  look.paint(3 * std::size_t{count}, look.add(std::move(material)));
}

Result<MeshSoup> read_binary(std::string_view bytes, std::uint32_t count, SoupLook* look) {
  if (count > kMaxMeshTriangles) return too_many_triangles();
  MeshSoup soup;
  soup.reserve(3 * static_cast<std::size_t>(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<float, 12> numbers{};  // the normal, then three corners
    std::memcpy(numbers.data(), bytes.data() + kHeaderBytes + kFacetBytes * i, sizeof numbers);
    for (std::size_t k = 3; k < 12; k += 3) {
      soup.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
      if (!is_finite(soup.back())) {
        return Error{fmt::format("triangle {} has a vertex that is not finite. Export it again.", i + 1)};
      }
    }
  }
  if (look != nullptr) read_facet_colors(bytes, count, *look);
  return soup;
}

/// Reads ASCII STL. Ignores normals, because many programs write nan there.
class AsciiReader {
 public:
  explicit AsciiReader(std::string_view text) : words_(text) {}

  Result<MeshSoup> read() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      const bool known = in_facet_ ? read_facet_word(word) : read_solid_word(word);
      if (!known) error_ = fmt::format("unexpected {} in ASCII STL", quoted_word(word));
      // a truncated file may end within a word: report the truncation instead
      if (!error_.empty() && words_.at_end()) break;
      if (!error_.empty()) return mesh_error(words_.line(), error_);
      if (soup_.size() > 3 * kMaxMeshTriangles) return too_many_triangles();
    }
    if (in_solid_) return mesh_error(words_.line(), "the ASCII STL ends without 'endsolid'");
    if (!error_.empty()) return mesh_error(words_.line(), error_);
    return std::move(soup_);
  }

 private:
  bool read_solid_word(std::string_view word) {
    if (equals_ignore_case(word, "solid") || equals_ignore_case(word, "endsolid")) {
      in_solid_ = word.size() == 5;
      words_.skip_line();
      return true;
    }
    in_facet_ = in_solid_ && equals_ignore_case(word, "facet");
    return in_facet_;
  }
  bool read_facet_word(std::string_view word) {
    if (equals_ignore_case(word, "normal")) {
      for (int i = 0; i < 3; ++i) words_.next();
    } else if (equals_ignore_case(word, "vertex")) {
      read_vertex();
    } else if (equals_ignore_case(word, "endfacet")) {
      in_facet_ = false;
      if (outline_.size() < 3) error_ = fmt::format("a facet has {} corners, not 3", outline_.size());
      triangulator_.triangulate(outline_, soup_);
      outline_.clear();
    } else {
      return equals_ignore_case(word, "outer") || equals_ignore_case(word, "loop") ||
             equals_ignore_case(word, "endloop");
    }
    return true;
  }
  void read_vertex() {
    Vec3 v(0);
    for (int i = 0; i < 3 && error_.empty(); ++i) {
      const std::string_view word = words_.next();
      const std::optional<double> number = parse_number(word);
      if (!number) error_ = fmt::format("{} is not a finite number", quoted_word(word));
      v[i] = number.value_or(0);
    }
    outline_.push_back(v);
  }

  MeshTokenizer words_;
  MeshSoup soup_;
  std::vector<Vec3> outline_;
  PolygonTriangulator triangulator_;
  std::string error_;
  bool in_solid_ = false;
  bool in_facet_ = false;
};

}  // namespace

Result<MeshSoup> soup_from_stl(std::string_view bytes, SoupLook* look) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeaderBytes) std::memcpy(&count, bytes.data() + kHeaderBytes - 4, sizeof count);
  const std::size_t expected_size = kHeaderBytes + kFacetBytes * static_cast<std::size_t>(count);
  const bool ascii = looks_ascii(bytes);
  if (count > 0 && (bytes.size() == expected_size || (bytes.size() > expected_size && !ascii)))
    return read_binary(bytes, count, look);
  if (ascii) return AsciiReader(bytes).read();
  return Error{
      "can't be read: neither ASCII STL nor binary STL of the length in its header. Export it again as binary STL."};
}

}  // namespace limber::model
