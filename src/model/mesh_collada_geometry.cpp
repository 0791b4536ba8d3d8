// The geometries of a Collada document: sources, index lists, and what they make of triangles.
#include <algorithm>

#include <fmt/format.h>

#include "model/mesh_collada.h"
#include "model/mesh_load.h"
#include "model/urdf_text.h"

namespace limber::collada {

namespace {

constexpr std::size_t kMostInFile = kMostUrdfBytes;  // no list has more entries than the file has bytes
constexpr std::size_t kMostStride = 1000;

enum class Kind { triangles, polylist, polygons, trifans, tristrips };
constexpr std::array<std::string_view, 5> kKinds{"triangles", "polylist", "polygons", "trifans", "tristrips"};

std::optional<Kind> kind_of(const Element* e) {
  const auto* found = std::find(kKinds.begin(), kKinds.end(), std::string_view(e->Name()));
  if (found == kKinds.end()) return {};
  return static_cast<Kind>(found - kKinds.begin());
}

Error no_whole_numbers(const Element* list, int line) {
  return mesh_fault(line, fmt::format("<{}> holds more than whole numbers", list->Name()));
}

/// How many corners each polygon of a <polylist> has.
Result<std::vector<std::size_t>> sizes_of(const Element* polylist, std::size_t corners) {
  std::vector<std::size_t> sizes;
  const Element* list = polylist->FirstChildElement("vcount");
  if (!list) return sizes;
  ElementWords words(list);
  std::size_t sum = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const std::optional<std::int64_t> size = parse_whole(word);
    if (!size) return no_whole_numbers(list, words.line());
    if (*size < 0 || static_cast<std::size_t>(*size) > corners - sum) {
      return mesh_fault(words.line(), fmt::format("<vcount> asks for more corners than <p> holds, {}", corners));
    }
    sizes.push_back(static_cast<std::size_t>(*size));
    sum += sizes.back();
  }
  if (words.is_foreign()) return no_whole_numbers(list, words.line());
  if (sum == corners) return sizes;
  return fault_at(list, fmt::format("<vcount> asks for {} corners where <p> holds {}", sum, corners));
}

void add_strip(std::span<const Vec3> corners, MeshSoup& soup) {
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    // every second one runs the other way round
    const std::size_t odd = i % 2;
    soup.insert(soup.end(), {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
  }
}

void add_fan(std::span<const Vec3> corners, MeshSoup& soup) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    soup.insert(soup.end(), {corners[0], corners[i], corners[i + 1]});
  }
}

}  // namespace

Result<const std::vector<double>*> Geometries::array_of(const Element* source, const Element* accessor,
                                                        const Ids& own) {
  const char* url = accessor->Attribute("source");
  const Element* array = own.find("float_array", url);
  if (!array) array = ids_.find("float_array", url);
  if (!array) array = source->FirstChildElement("float_array");
  if (!array) return fault_at(source, "a source has no <float_array>");
  const auto [entry, is_new] = arrays_.try_emplace(array);
  if (is_new) {
    const Result<std::size_t> count = whole_attribute(array, "count", 0, kMostInFile);
    if (!count) return Error{count.error()};
    Result<std::vector<double>> numbers = numbers_of(array, *count);
    if (!numbers) return Error{numbers.error()};
    entry->second = std::move(*numbers);
  }
  return &entry->second;
}

Result<Geometries::Points> Geometries::points_of(const Element* source, const Ids& own) {
  const auto known = points_.find(source);
  if (known != points_.end()) return known->second;
  const Element* common = source->FirstChildElement("technique_common");
  const Element* accessor = common ? common->FirstChildElement("accessor") : nullptr;
  if (!accessor) return fault_at(source, "a source has no <accessor>");
  const Result<const std::vector<double>*> numbers = array_of(source, accessor, own);
  if (!numbers) return Error{numbers.error()};
  Points points;
  points.numbers = *numbers;
  const Result<std::size_t> count = whole_attribute(accessor, "count", 0, kMostInFile);
  const Result<std::size_t> stride = whole_attribute(accessor, "stride", 1, kMostStride);
  const Result<std::size_t> offset = whole_attribute(accessor, "offset", 0, kMostInFile);
  for (const auto* attribute : {&count, &stride, &offset}) {
    if (!*attribute) return Error{attribute->error()};
  }
  points.count = *count, points.stride = *stride, points.offset = *offset;
  int named = 0;
  std::size_t at = 0;
  for (const Element* e = accessor->FirstChildElement("param"); e; e = e->NextSiblingElement("param"), ++at) {
    const char* name = e->Attribute("name");
    const std::size_t axis = name && name[0] != 0 && name[1] == 0 ? std::string_view("XYZ").find(*name) : 3;
    if (axis >= 3) continue;
    points.axis[axis] = at;
    named |= 1 << axis;
  }
  const std::size_t farthest = *std::max_element(points.axis.begin(), points.axis.end());
  if ((named != 0 && named != 7) || farthest >= points.stride) {
    return fault_at(accessor, "an accessor of points has no X, Y and Z");
  }
  if (points.count > 0 && points.offset + (points.count - 1) * points.stride + farthest >= points.numbers->size()) {
    return fault_at(accessor, fmt::format("an accessor asks for {} points, more than its {} numbers hold", points.count,
                                          points.numbers->size()));
  }
  points_.emplace(source, points);
  return points;
}

const Element* Geometries::source_of(const Element* vertices, const Ids& own) {
  const auto [entry, is_new] = sources_.try_emplace(vertices, nullptr);
  const Element* input = is_new ? vertices->FirstChildElement("input") : nullptr;
  for (; input; input = input->NextSiblingElement("input")) {
    const char* semantic = input->Attribute("semantic");
    if (!semantic || std::string_view(semantic) != "POSITION") continue;
    entry->second = own.find("source", input->Attribute("source"));
    if (!entry->second) entry->second = ids_.find("source", input->Attribute("source"));
  }
  return entry->second;
}

Result<Geometries::Layout> Geometries::layout_of(const Element* primitive, const Ids& own) {
  Layout layout;
  const Element* source = nullptr;
  for (const Element* e = primitive->FirstChildElement("input"); e; e = e->NextSiblingElement("input")) {
    const Result<std::size_t> offset = whole_attribute(e, "offset", 0, kMostStride);
    if (!offset) return Error{offset.error()};
    layout.stride = std::max(layout.stride, *offset + 1);
    const char* semantic = e->Attribute("semantic");
    const char* url = e->Attribute("source");
    if (!semantic || std::string_view(semantic) != "VERTEX") continue;
    layout.offset = *offset;
    const Element* vertices = own.find("vertices", url);
    if (!vertices) return fault_at(e, fmt::format("there are no vertices {}", quoted_word(url ? url : "")));
    source = source_of(vertices, own);
  }
  if (!source) return fault_at(primitive, fmt::format("<{}> has no points to join", primitive->Name()));
  const Result<Points> points = points_of(source, own);
  if (!points) return Error{points.error()};
  layout.points = *points;
  return layout;
}

Result<void> Geometries::read_list(const Element* list, const Layout& layout, std::vector<Vec3>& corners) {
  const Points& points = layout.points;
  ElementWords words(list);
  std::size_t at = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++at) {
    const std::optional<std::int64_t> index = parse_whole(word);
    if (!index) return no_whole_numbers(list, words.line());
    if (at % layout.stride != layout.offset) continue;
    if (*index < 0 || static_cast<std::size_t>(*index) >= points.count) {
      return mesh_fault(words.line(), fmt::format("there is no point {}; there are {}", *index, points.count));
    }
    const double* first = points.numbers->data() + points.offset + static_cast<std::size_t>(*index) * points.stride;
    corners.emplace_back(first[points.axis[0]], first[points.axis[1]], first[points.axis[2]]);
  }
  if (words.is_foreign()) return no_whole_numbers(list, words.line());
  if (at % layout.stride == 0) return {};
  return fault_at(list, fmt::format("<{}> holds {} numbers, no multiple of {}", list->Name(), at, layout.stride));
}

/// Triangles and polylists: all lists are one.
Result<void> Geometries::read_joined(const Element* primitive, const Layout& layout, MeshSoup& soup) {
  std::vector<Vec3> corners;
  for (const Element* p = primitive->FirstChildElement("p"); p; p = p->NextSiblingElement("p")) {
    if (Result<void> read = read_list(p, layout, corners); !read) return read;
  }
  std::size_t found = corners.size() / 3;
  if (kind_of(primitive) == Kind::polylist) {
    const Result<std::vector<std::size_t>> sizes = sizes_of(primitive, corners.size());
    if (!sizes) return Error{sizes.error()};
    std::span<const Vec3> rest(corners);
    for (const std::size_t size : *sizes) {
      cutter_.cut(rest.first(size), soup);
      rest = rest.subspan(size);
    }
    found = sizes->size();
  } else if (corners.size() % 3 == 0) {
    soup.insert(soup.end(), corners.begin(), corners.end());
  } else {
    return fault_at(primitive, fmt::format("<triangles> holds {} corners, no multiple of 3", corners.size()));
  }
  const Result<std::size_t> count = whole_attribute(primitive, "count", found, kMostInFile);
  if (!count) return Error{count.error()};
  if (*count == found) return {};
  return fault_at(primitive, fmt::format("<{}> says count='{}' and holds {}", primitive->Name(), *count, found));
}

/// Polygons, strips and fans: one list each. Of a polygon with holes, its outline counts.
Result<void> Geometries::read_each(const Element* primitive, const Layout& layout, MeshSoup& soup) {
  const std::optional<Kind> kind = kind_of(primitive);
  std::vector<Vec3> corners;
  for (const Element* e = primitive->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const Element* list = is_named(e, "ph") ? e->FirstChildElement("p") : e;
    if (!list || !is_named(list, "p")) continue;
    corners.clear();
    if (Result<void> read = read_list(list, layout, corners); !read) return read;
    if (kind == Kind::polygons) {
      cutter_.cut(corners, soup);
    } else if (kind == Kind::trifans) {
      add_fan(corners, soup);
    } else {
      add_strip(corners, soup);
    }
  }
  const Result<std::size_t> count = whole_attribute(primitive, "count", 0, kMostInFile);
  return count ? Result<void>() : Error{count.error()};
}

Result<const MeshSoup*> Geometries::read(const Element* geometry) {
  const auto [entry, is_new] = soups_.try_emplace(geometry);
  MeshSoup& soup = entry->second;
  if (!is_new) return &soup;
  const Element* mesh = geometry->FirstChildElement("mesh");
  if (!mesh) mesh = geometry->FirstChildElement("convex_mesh");
  // curves and the like have no triangles
  if (!mesh) return &soup;
  const Ids own(mesh);
  for (const Element* e = mesh->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::optional<Kind> kind = kind_of(e);
    if (!kind) continue;
    const Result<Layout> layout = layout_of(e, own);
    if (!layout) return Error{layout.error()};
    const bool joined = kind == Kind::triangles || kind == Kind::polylist;
    const Result<void> read = joined ? read_joined(e, *layout, soup) : read_each(e, *layout, soup);
    if (!read) return Error{read.error()};
    if (corners_ + soup.size() > 3 * kMostMeshTriangles) return too_many_triangles();
  }
  corners_ += soup.size();
  return &soup;
}

}  // namespace limber::collada
