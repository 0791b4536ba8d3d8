// Shared parts of the mesh readers: tokenizer, polygon triangulation and error texts.
#include "model/mesh/triangles.h"

#include <algorithm>
#include <charconv>
#include <numeric>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/load.h"

namespace limber::model {

namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Twice the signed area of the triangle a-b-c times the normal's length; positive for a left turn seen against the
/// normal.
double signed_area(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return glm::dot(glm::cross(b - a, c - b), normal);
}

/// Newell's normal of any closed polygon; its length is twice the enclosed area.
Vec3 newell_normal(std::span<const Vec3> corners) {
  Vec3 area(0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return area;
}

void add_triangle_fan(std::span<const std::size_t> corners, std::vector<std::size_t>& out) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    out.insert(out.end(), {corners[0], corners[i], corners[i + 1]});
  }
}

/// True if a-b-c is a left turn and contains none of the `remaining` corners. Corners at the positions of a, b or c
/// (bridges to holes) are ignored.
bool is_ear(const Vec3& a, const Vec3& b, const Vec3& c, std::span<const Vec3> corners,
            std::span<const std::size_t> remaining, const Vec3& normal) {
  if (!(signed_area(a, b, c, normal) > 0)) return false;
  return std::none_of(remaining.begin(), remaining.end(), [&](std::size_t i) {
    const Vec3& p = corners[i];
    if (p == a || p == b || p == c) return false;
    return signed_area(a, b, p, normal) >= 0 && signed_area(b, c, p, normal) >= 0 && signed_area(c, a, p, normal) >= 0;
  });
}

}  // namespace

Error mesh_error(int line, std::string_view text) {
  return Error{fmt::format("line {}: {}. Export it again, or as binary STL.", line, text)};
}

Error too_many_triangles() { return Error{fmt::format("has more than {} triangles. Simplify it.", kMaxMeshTriangles)}; }

std::string quoted_word(std::string_view word) {
  constexpr std::size_t kMaxLength = 24;
  return fmt::format("'{}{}'", printable(word.substr(0, kMaxLength)), word.size() > kMaxLength ? "…" : "");
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

void MeshTokenizer::advance() {
  const char c = text_[position_++];
  if (c == '\n' || (c == '\r' && (position_ == text_.size() || text_[position_] != '\n'))) ++current_line_;
}

std::string_view MeshTokenizer::next() {
  while (position_ < text_.size() && is_blank(text_[position_])) advance();
  line_ = current_line_;
  const std::size_t from = position_;
  while (position_ < text_.size() && !is_blank(text_[position_])) ++position_;
  return text_.substr(from, position_ - from);
}

void MeshTokenizer::skip_line() {
  while (position_ < text_.size() && current_line_ == line_) advance();
}

void PolygonTriangulator::triangulate(std::span<const Vec3> corners, MeshSoup& out) {
  indices_.clear();
  triangulate(corners, indices_);
  for (const std::size_t i : indices_) out.push_back(corners[i]);
}

void PolygonTriangulator::triangulate(std::span<const Vec3> corners, std::vector<std::size_t>& out) {
  const std::size_t count = corners.size();
  const Vec3 normal = count > 3 ? newell_normal(corners) : Vec3(0);
  bool convex = true;
  for (std::size_t i = 0; i < count && convex && count > 3; ++i) {
    convex = signed_area(corners[i], corners[(i + 1) % count], corners[(i + 2) % count], normal) >= 0;
  }
  if (!convex) return clip_ears(corners, normal, out);
  for (std::size_t i = 1; i + 1 < count; ++i) out.insert(out.end(), {0, i, i + 1});
}

void PolygonTriangulator::clip_ears(std::span<const Vec3> corners, const Vec3& normal, std::vector<std::size_t>& out) {
  std::vector<std::size_t> remaining(corners.size());
  std::iota(remaining.begin(), remaining.end(), std::size_t{0});
  std::size_t at = 0, failures = 0;
  while (remaining.size() > 3 && failures < remaining.size() && steps_left_ > remaining.size()) {
    steps_left_ -= remaining.size();
    const std::size_t count = remaining.size();
    const std::size_t a = remaining[(at + count - 1) % count];
    const std::size_t b = remaining[at];
    const std::size_t c = remaining[(at + 1) % count];
    if (is_ear(corners[a], corners[b], corners[c], corners, remaining, normal)) {
      out.insert(out.end(), {a, b, c});
      remaining.erase(remaining.begin() + static_cast<std::ptrdiff_t>(at));
      at = at == count - 1 ? 0 : at;
      failures = 0;
    } else {
      at = (at + 1) % count;
      ++failures;
    }
  }
  add_triangle_fan(remaining, out);
}

}  // namespace limber::model
