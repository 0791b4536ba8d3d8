// Words of mesh texts, polygons into triangles, and the texts of errors that the readers share.
#include "model/mesh_soup.h"

#include <algorithm>
#include <charconv>
#include <numeric>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh_load.h"

namespace limber {

namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// How far the way a-b-c turns to the left, seen against the normal: twice the area.
double turn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return glm::dot(glm::cross(b - a, c - b), normal);
}

/// Newell's normal: twice the area of the outline, whatever its shape.
Vec3 area_of(std::span<const Vec3> corners) {
  Vec3 area(0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return area;
}

void fan(std::span<const Vec3> corners, MeshSoup& out) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    out.insert(out.end(), {corners[0], corners[i], corners[i + 1]});
  }
}

/// Whether a-b-c turns left and no other corner lies in it. Corners at the same place (bridges to holes) don't count.
bool is_ear(const Vec3& a, const Vec3& b, const Vec3& c, std::span<const Vec3> corners, const Vec3& normal) {
  if (!(turn(a, b, c, normal) > 0)) return false;
  return std::none_of(corners.begin(), corners.end(), [&](const Vec3& p) {
    if (p == a || p == b || p == c) return false;
    return turn(a, b, p, normal) >= 0 && turn(b, c, p, normal) >= 0 && turn(c, a, p, normal) >= 0;
  });
}

}  // namespace

Error mesh_fault(int line, std::string_view text) {
  return Error{fmt::format("line {}: {}. Export it again, or as binary STL.", line, text)};
}

Error too_many_triangles() {
  return Error{fmt::format("has more than {} triangles. Simplify it.", kMostMeshTriangles)};
}

std::string quoted_word(std::string_view word) {
  constexpr std::size_t kMost = 24;
  return fmt::format("'{}{}'", printable(word.substr(0, kMost)), word.size() > kMost ? "…" : "");
}

std::optional<std::int64_t> parse_whole(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

void MeshWords::step() {
  const char c = text_[at_++];
  if (c == '\n' || (c == '\r' && (at_ == text_.size() || text_[at_] != '\n'))) ++here_;
}

std::string_view MeshWords::next() {
  while (at_ < text_.size() && is_blank(text_[at_])) step();
  line_ = here_;
  const std::size_t from = at_;
  while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
  return text_.substr(from, at_ - from);
}

void MeshWords::skip_line() {
  while (at_ < text_.size() && here_ == line_) step();
}

void PolygonCutter::cut(std::span<const Vec3> corners, MeshSoup& out) {
  const std::size_t count = corners.size();
  const Vec3 normal = count > 3 ? area_of(corners) : Vec3(0);
  bool convex = true;
  for (std::size_t i = 0; i < count && convex && count > 3; ++i) {
    convex = turn(corners[i], corners[(i + 1) % count], corners[(i + 2) % count], normal) >= 0;
  }
  if (convex) {
    fan(corners, out);
  } else {
    clip_ears(corners, normal, out);
  }
}

void PolygonCutter::clip_ears(std::span<const Vec3> corners, const Vec3& normal, MeshSoup& out) {
  std::vector<Vec3> left(corners.begin(), corners.end());
  std::size_t at = 0, in_vain = 0;
  while (left.size() > 3 && in_vain < left.size() && steps_left_ > left.size()) {
    steps_left_ -= left.size();
    const std::size_t count = left.size();
    const Vec3& a = left[(at + count - 1) % count];
    const Vec3& b = left[at];
    const Vec3& c = left[(at + 1) % count];
    if (is_ear(a, b, c, left, normal)) {
      out.insert(out.end(), {a, b, c});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
      at = at == count - 1 ? 0 : at;
      in_vain = 0;
    } else {
      at = (at + 1) % count;
      ++in_vain;
    }
  }
  fan(left, out);
}

}  // namespace limber
