// Reads STL: binary by the length that it says, ASCII by its words.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh_load.h"
#include "model/mesh_soup.h"

namespace limber {

namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t kHeader = 84;
constexpr std::size_t kFacet = 50;

bool same_letter(char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a + ('a' - 'A')) : a) == b; }

/// Whether the word is there, in whatever case; `word` in small letters.
bool is_word(std::string_view text, std::string_view word) {
  return text.size() == word.size() && std::equal(text.begin(), text.end(), word.begin(), same_letter);
}
bool holds(std::string_view text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(), same_letter) != text.end();
}

bool looks_ascii(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 512);
  const bool text = std::none_of(start.begin(), start.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < '\t' || code == 127 || (code > '\r' && code < ' ');
  });
  return text && is_word(MeshWords(start).next().substr(0, 5), "solid") && holds(bytes, "facet") &&
         holds(bytes, "vertex");
}

Result<MeshSoup> read_binary(std::string_view bytes, std::uint32_t count) {
  if (count > kMostMeshTriangles) return too_many_triangles();
  MeshSoup soup;
  soup.reserve(3 * static_cast<std::size_t>(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<float, 12> numbers{};  // the normal, then three corners
    std::memcpy(numbers.data(), bytes.data() + kHeader + kFacet * i, sizeof numbers);
    for (std::size_t k = 3; k < 12; k += 3) {
      soup.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
      if (!is_finite(soup.back())) {
        return Error{fmt::format("triangle {} has a vertex that is not finite. Export it again.", i + 1)};
      }
    }
  }
  return soup;
}

/// The words of ASCII STL. Normals are not read: many programs write nan there.
class AsciiReader {
 public:
  explicit AsciiReader(std::string_view text) : words_(text) {}

  Result<MeshSoup> read() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      const bool known = inside_ ? facet_word(word) : solid_word(word);
      if (!known) fault_ = fmt::format("{} stands where ASCII STL has no such word", quoted_word(word));
      // the last word of a file that was cut off is no word, nor need it be a number
      if (!fault_.empty() && words_.at_end()) break;
      if (!fault_.empty()) return mesh_fault(words_.line(), fault_);
      if (soup_.size() > 3 * kMostMeshTriangles) return too_many_triangles();
    }
    if (open_) return mesh_fault(words_.line(), "the ASCII STL stops before 'endsolid'");
    if (!fault_.empty()) return mesh_fault(words_.line(), fault_);
    return std::move(soup_);
  }

 private:
  bool solid_word(std::string_view word) {
    if (is_word(word, "solid") || is_word(word, "endsolid")) {
      open_ = word.size() == 5;
      words_.skip_line();
      return true;
    }
    inside_ = open_ && is_word(word, "facet");
    return inside_;
  }
  bool facet_word(std::string_view word) {
    if (is_word(word, "normal")) {
      for (int i = 0; i < 3; ++i) words_.next();
    } else if (is_word(word, "vertex")) {
      vertex();
    } else if (is_word(word, "endfacet")) {
      inside_ = false;
      if (outline_.size() < 3) fault_ = fmt::format("a facet has {} corners, not 3", outline_.size());
      cutter_.cut(outline_, soup_);
      outline_.clear();
    } else {
      return is_word(word, "outer") || is_word(word, "loop") || is_word(word, "endloop");
    }
    return true;
  }
  void vertex() {
    Vec3 v(0);
    for (int i = 0; i < 3 && fault_.empty(); ++i) {
      const std::string_view word = words_.next();
      const std::optional<double> number = parse_number(word);
      if (!number) fault_ = fmt::format("{} is no finite number", quoted_word(word));
      v[i] = number.value_or(0);
    }
    outline_.push_back(v);
  }

  MeshWords words_;
  MeshSoup soup_;
  std::vector<Vec3> outline_;
  PolygonCutter cutter_;
  std::string fault_;
  bool open_ = false;    // in a solid
  bool inside_ = false;  // in a facet
};

}  // namespace

Result<MeshSoup> soup_from_stl(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + kHeader - 4, sizeof count);
  const std::size_t said = kHeader + kFacet * static_cast<std::size_t>(count);
  const bool ascii = looks_ascii(bytes);
  if (count > 0 && (bytes.size() == said || (bytes.size() > said && !ascii))) return read_binary(bytes, count);
  if (ascii) return AsciiReader(bytes).read();
  return Error{"can't be read: neither ASCII STL nor binary STL as long as it says. Export it again as binary STL."};
}

}  // namespace limber
