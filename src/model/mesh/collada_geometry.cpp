// Geometries of a Collada document: reads sources and index lists and converts polygons, fans and strips to triangles.
#include <algorithm>

#include <fmt/format.h>

#include "model/mesh/collada.h"
#include "model/mesh/load.h"
#include "model/xml_text.h"

namespace limber::model::collada {

namespace {

constexpr std::size_t kMaxEntries = kMaxUrdfBytes;  // a list can't have more entries than the file has bytes
constexpr std::size_t kMaxStride = 1000;

enum class Kind { triangles, polylist, polygons, trifans, tristrips };
constexpr std::array<std::string_view, 5> kKinds{"triangles", "polylist", "polygons", "trifans", "tristrips"};

std::optional<Kind> kind_of(const Element* e) {
  const auto* found = std::find(kKinds.begin(), kKinds.end(), std::string_view(e->Name()));
  if (found == kKinds.end()) return {};
  return static_cast<Kind>(found - kKinds.begin());
}

Error not_integers(const Element* list, int line) {
  return mesh_error(line, fmt::format("<{}> must contain integers only", list->Name()));
}

/// The number of corners of each polygon of a <polylist>.
Result<std::vector<std::size_t>> polygon_sizes(const Element* polylist, std::size_t corners) {
  std::vector<std::size_t> sizes;
  const Element* list = polylist->FirstChildElement("vcount");
  if (!list) return sizes;
  ElementTokenizer words(list);
  std::size_t sum = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const std::optional<std::int64_t> size = parse_integer(word);
    if (!size) return not_integers(list, words.line());
    if (*size < 0 || static_cast<std::size_t>(*size) > corners - sum) {
      return mesh_error(words.line(), fmt::format("<vcount> requires more corners than the {} in <p>", corners));
    }
    sizes.push_back(static_cast<std::size_t>(*size));
    sum += sizes.back();
  }
  if (words.found_non_text()) return not_integers(list, words.line());
  if (sum == corners) return sizes;
  return error_at(list, fmt::format("<vcount> requires {} corners, but <p> contains {}", sum, corners));
}

// Reads the positions of X, Y and Z among the parameters of an accessor. Returns a bit for each that it names.
template <class Axes>
int read_axes(const Element& accessor, Axes& axes) {
  int found = 0;
  std::size_t at = 0;
  for (const Element* e = accessor.FirstChildElement("param"); e; e = e->NextSiblingElement("param"), ++at) {
    const char* name = e->Attribute("name");
    const std::size_t axis = name && name[0] != 0 && name[1] == 0 ? std::string_view("XYZ").find(*name) : 3;
    if (axis >= 3) continue;
    axes[axis] = at;
    found |= 1 << axis;
  }
  return found;
}

const Element* accessor_of(const Element* source) {
  const Element* common = source->FirstChildElement("technique_common");
  return common ? common->FirstChildElement("accessor") : nullptr;
}

}  // namespace

Result<const std::vector<double>*> GeometryReader::array_of(const Element* source, const Element* accessor,
                                                            const IdIndex& local_ids) {
  const char* url = accessor->Attribute("source");
  const Element* array = local_ids.find("float_array", url);
  if (!array) array = ids_.find("float_array", url);
  if (!array) array = source->FirstChildElement("float_array");
  if (!array) return error_at(source, "a source has no <float_array>");
  const auto [entry, is_new] = arrays_.try_emplace(array);
  if (is_new) {
    const Result<std::size_t> count = integer_attribute(array, "count", 0, kMaxEntries);
    if (!count) return Error{count.error()};
    Result<std::vector<double>> numbers = numbers_of(array, *count);
    if (!numbers) return Error{numbers.error()};
    entry->second = std::move(*numbers);
  }
  return &entry->second;
}

Result<GeometryReader::Points> GeometryReader::view_of(const Element* source, const Element* accessor,
                                                       const IdIndex& local_ids) {
  const Result<const std::vector<double>*> numbers = array_of(source, accessor, local_ids);
  if (!numbers) return Error{numbers.error()};
  Points points;
  points.numbers = *numbers;
  const Result<std::size_t> count = integer_attribute(accessor, "count", 0, kMaxEntries);
  const Result<std::size_t> stride = integer_attribute(accessor, "stride", 1, kMaxStride);
  const Result<std::size_t> offset = integer_attribute(accessor, "offset", 0, kMaxEntries);
  for (const auto* attribute : {&count, &stride, &offset}) {
    if (!*attribute) return Error{attribute->error()};
  }
  points.count = *count, points.stride = *stride, points.offset = *offset;
  return points;
}

Result<GeometryReader::Points> GeometryReader::points_of(const Element* source, const IdIndex& local_ids) {
  const auto known = points_.find(source);
  if (known != points_.end()) return known->second;
  const Element* accessor = accessor_of(source);
  if (!accessor) return error_at(source, "a source has no <accessor>");
  Result<Points> read = view_of(source, accessor, local_ids);
  if (!read) return read;
  Points& points = *read;
  const int axes_found = read_axes(*accessor, points.axis);
  const std::size_t farthest = *std::max_element(points.axis.begin(), points.axis.end());
  if ((axes_found != 0 && axes_found != 7) || farthest >= points.stride) {
    return error_at(accessor, "an accessor of positions has no X, Y and Z");
  }
  if (points.count > 0 && points.offset + (points.count - 1) * points.stride + farthest >= points.numbers->size()) {
    return error_at(accessor, fmt::format("an accessor has {} points, too many for its {} numbers", points.count,
                                          points.numbers->size()));
  }
  points_.emplace(source, points);
  return points;
}

const Element* GeometryReader::source_of(const Element* vertices, const IdIndex& local_ids) {
  const auto [entry, is_new] = sources_.try_emplace(vertices, nullptr);
  const Element* input = is_new ? vertices->FirstChildElement("input") : nullptr;
  for (; input; input = input->NextSiblingElement("input")) {
    const char* semantic = input->Attribute("semantic");
    if (!semantic || std::string_view(semantic) != "POSITION") continue;
    entry->second = local_ids.find("source", input->Attribute("source"));
    if (!entry->second) entry->second = ids_.find("source", input->Attribute("source"));
  }
  return entry->second;
}

Result<GeometryReader::Layout> GeometryReader::layout_of(const Element* primitive, const IdIndex& local_ids) {
  Layout layout;
  const Element* source = nullptr;
  for (const Element* e = primitive->FirstChildElement("input"); e; e = e->NextSiblingElement("input")) {
    const Result<std::size_t> offset = integer_attribute(e, "offset", 0, kMaxStride);
    if (!offset) return Error{offset.error()};
    layout.stride = std::max(layout.stride, *offset + 1);
    const char* semantic = e->Attribute("semantic");
    const char* url = e->Attribute("source");
    if (!semantic || std::string_view(semantic) != "VERTEX") continue;
    layout.offset = *offset;
    const Element* vertices = local_ids.find("vertices", url);
    if (!vertices) return error_at(e, fmt::format("vertices {} not found", quoted_word(url ? url : "")));
    source = source_of(vertices, local_ids);
  }
  if (!source) return error_at(primitive, fmt::format("<{}> has no vertex positions", primitive->Name()));
  const Result<Points> points = points_of(source, local_ids);
  if (!points) return Error{points.error()};
  layout.points = *points;
  if (look_ != nullptr) find_texcoords(primitive, local_ids, layout);
  return layout;
}

/// Uses the first set of texture coordinates; without one that can be read, the layout has none.
void GeometryReader::find_texcoords(const Element* primitive, const IdIndex& local_ids, Layout& layout) {
  for (const Element* e = primitive->FirstChildElement("input"); e; e = e->NextSiblingElement("input")) {
    const char* semantic = e->Attribute("semantic");
    if (!semantic || std::string_view(semantic) != "TEXCOORD") continue;
    if (layout.texcoords) {
      look_->report(Severity::note, "texcoord sets", "further sets of texture coordinates are not used",
                    "Nothing to do, unless a texture appears misplaced.");
      return;
    }
    const Element* source = local_ids.find("source", e->Attribute("source"));
    const Element* accessor = source ? accessor_of(source) : nullptr;
    const Result<std::size_t> offset = integer_attribute(e, "offset", 0, kMaxStride);
    Result<Points> view = accessor ? view_of(source, accessor, local_ids) : Result<Points>(Error{"no accessor"});
    const bool fits = view && offset && view->stride >= 2 && view->count > 0 &&
                      view->offset + (view->count - 1) * view->stride + 1 < view->numbers->size();
    if (!fits) {
      look_->report(Severity::warning, "texcoords", "texture coordinates can't be read; its textures are not drawn",
                    "Export the mesh again.");
      continue;
    }
    layout.texcoords = *view;
    layout.texcoord_offset = *offset;
  }
}

Result<void> GeometryReader::read_indices(const Element* list, const Layout& layout, Corners& corners) {
  const Points& points = layout.points;
  ElementTokenizer words(list);
  std::size_t at = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++at) {
    const std::optional<std::int64_t> index = parse_integer(word);
    if (!index) return not_integers(list, words.line());
    if (layout.texcoords && at % layout.stride == layout.texcoord_offset) {
      const Points& texcoords = *layout.texcoords;
      TexCoord& texcoord = corners.texcoords.emplace_back();
      if (*index >= 0 && static_cast<std::size_t>(*index) < texcoords.count) {
        const double* st =
            texcoords.numbers->data() + texcoords.offset + static_cast<std::size_t>(*index) * texcoords.stride;
        // they start at the bottom left
        texcoord = {static_cast<float>(std::clamp(st[0], -1e4, 1e4)),
                    static_cast<float>(std::clamp(1 - st[1], -1e4, 1e4))};
      }
    }
    if (at % layout.stride != layout.offset) continue;
    if (*index < 0 || static_cast<std::size_t>(*index) >= points.count) {
      return mesh_error(words.line(), fmt::format("point {} not found; there are {}", *index, points.count));
    }
    const double* first = points.numbers->data() + points.offset + static_cast<std::size_t>(*index) * points.stride;
    corners.points.emplace_back(first[points.axis[0]], first[points.axis[1]], first[points.axis[2]]);
  }
  if (words.found_non_text()) return not_integers(list, words.line());
  if (at % layout.stride == 0) return {};
  return error_at(list,
                  fmt::format("<{}> contains {} numbers, expected a multiple of {}", list->Name(), at, layout.stride));
}

void GeometryReader::add_corner(const Corners& corners, std::size_t corner, GeometrySoup& soup) {
  soup.points.push_back(corners.points[corner]);
  if (corner >= corners.texcoords.size()) return;
  soup.texcoords.resize(soup.points.size());
  soup.texcoords.back() = corners.texcoords[corner];
}

void GeometryReader::add_polygon(const Corners& corners, std::size_t first, std::size_t count, GeometrySoup& soup) {
  indices_.clear();
  triangulator_.triangulate(std::span(corners.points).subspan(first, count), indices_);
  for (const std::size_t i : indices_) add_corner(corners, first + i, soup);
}

void GeometryReader::add_strip(const Corners& corners, GeometrySoup& soup) {
  for (std::size_t i = 0; i + 2 < corners.points.size(); ++i) {
    // every second triangle of a strip has the opposite winding
    const std::size_t odd = i % 2;
    for (const std::size_t k : {i, i + 1 + odd, i + 2 - odd}) add_corner(corners, k, soup);
  }
}

void GeometryReader::add_fan(const Corners& corners, GeometrySoup& soup) {
  for (std::size_t i = 1; i + 1 < corners.points.size(); ++i) {
    for (const std::size_t k : {std::size_t{0}, i, i + 1}) add_corner(corners, k, soup);
  }
}

/// Reads <triangles> and <polylist>: their <p> lists are concatenated.
Result<void> GeometryReader::read_concatenated_lists(const Element* primitive, const Layout& layout,
                                                     GeometrySoup& soup) {
  Corners corners;
  for (const Element* p = primitive->FirstChildElement("p"); p; p = p->NextSiblingElement("p")) {
    if (Result<void> read = read_indices(p, layout, corners); !read) return read;
  }
  const std::size_t total = corners.points.size();
  std::size_t found = total / 3;
  if (kind_of(primitive) == Kind::polylist) {
    const Result<std::vector<std::size_t>> sizes = polygon_sizes(primitive, total);
    if (!sizes) return Error{sizes.error()};
    std::size_t first = 0;
    for (const std::size_t size : *sizes) {
      add_polygon(corners, first, size, soup);
      first += size;
    }
    found = sizes->size();
  } else if (total % 3 == 0) {
    for (std::size_t i = 0; i < total; ++i) add_corner(corners, i, soup);
  } else {
    return error_at(primitive, fmt::format("<triangles> contains {} corners, expected a multiple of 3", total));
  }
  const Result<std::size_t> count = integer_attribute(primitive, "count", found, kMaxEntries);
  if (!count) return Error{count.error()};
  if (*count == found) return {};
  return error_at(primitive, fmt::format("<{}> has count='{}', but contains {}", primitive->Name(), *count, found));
}

/// Reads <polygons>, <tristrips> and <trifans>: one <p> list each. Holes of polygons are ignored.
Result<void> GeometryReader::read_separate_lists(const Element* primitive, const Layout& layout, GeometrySoup& soup) {
  const std::optional<Kind> kind = kind_of(primitive);
  Corners corners;
  for (const Element* e = primitive->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const Element* list = is_named(e, "ph") ? e->FirstChildElement("p") : e;
    if (!list || !is_named(list, "p")) continue;
    corners.clear();
    if (Result<void> read = read_indices(list, layout, corners); !read) return read;
    if (kind == Kind::polygons) {
      add_polygon(corners, 0, corners.points.size(), soup);
    } else if (kind == Kind::trifans) {
      add_fan(corners, soup);
    } else {
      add_strip(corners, soup);
    }
  }
  const Result<std::size_t> count = integer_attribute(primitive, "count", 0, kMaxEntries);
  return count ? Result<void>() : Error{count.error()};
}

Result<const GeometrySoup*> GeometryReader::read(const Element* geometry) {
  const auto [entry, is_new] = soups_.try_emplace(geometry);
  GeometrySoup& soup = entry->second;
  if (!is_new) return &soup;
  const Element* mesh = geometry->FirstChildElement("mesh");
  if (!mesh) mesh = geometry->FirstChildElement("convex_mesh");
  // other geometries, such as splines, have no triangles
  if (!mesh) return &soup;
  const IdIndex local_ids(mesh);
  for (const Element* e = mesh->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::optional<Kind> kind = kind_of(e);
    if (!kind) continue;
    const Result<Layout> layout = layout_of(e, local_ids);
    if (!layout) return Error{layout.error()};
    const bool joined = kind == Kind::triangles || kind == Kind::polylist;
    const Result<void> read =
        joined ? read_concatenated_lists(e, *layout, soup) : read_separate_lists(e, *layout, soup);
    if (!read) return Error{read.error()};
    if (corners_ + soup.points.size() > 3 * kMaxMeshTriangles) return too_many_triangles();
    const char* symbol = e->Attribute("material");
    soup.symbols.emplace_back(symbol ? symbol : "");
    soup.triangle_symbols.resize(soup.points.size() / 3, static_cast<std::uint32_t>(soup.symbols.size() - 1));
  }
  if (!soup.texcoords.empty()) soup.texcoords.resize(soup.points.size());
  corners_ += soup.points.size();
  return &soup;
}

}  // namespace limber::model::collada
