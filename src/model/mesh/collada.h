// Collada reader: helpers for elements and ids, the scene graph, and the readers of geometries and materials. Internal
// to the module: only collada*.cpp includes it.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <tinyxml2.h>

#include "base/result.h"
#include "base/vec.h"
#include "model/look/soup_look.h"
#include "model/mesh/triangles.h"

namespace limber::model::collada {

using Element = tinyxml2::XMLElement;

/// The next element in document order within `top`; null at the end. Skips the contents of <extra> and <technique>,
/// which hold program-specific data. [any]
const Element* next_element(const Element* element, const Element* top);
bool is_named(const Element* element, std::string_view name);

/// An error that starts with the element's line: "line 3: …". [any]
Error error_at(const Element* element, std::string_view text);
/// An integer attribute from 0 to `max_value`; `fallback` if the attribute is absent. [any]
Result<std::size_t> integer_attribute(const Element* element, const char* name, std::size_t fallback,
                                      std::size_t max_value);

/// Splits an element's text into words; skips comments between them.
class ElementTokenizer {
 public:
  explicit ElementTokenizer(const Element* element) : node_(element->FirstChild()), line_(element->GetLineNum()) {}

  /// The next word; empty at the end, and at a child that is neither text nor comment: then found_non_text() is true.
  std::string_view next();
  int line() const { return line_; }
  bool found_non_text() const { return found_non_text_; }

 private:
  const tinyxml2::XMLNode* node_;  // the child after the text in words_
  MeshTokenizer tokenizer_{{}};
  int line_;
  bool found_non_text_ = false;
};

/// The numbers in an element's text. Errors if any is not finite, or if there are fewer than `min_count`. [any]
Result<std::vector<double>> numbers_of(const Element* element, std::size_t min_count);

/// Index of the elements below `top` by element name and id.
class IdIndex {
 public:
  explicit IdIndex(const Element* top);
  /// Finds an element by "#id" or "id"; nodes also by sid and name, if no node has that id. Null if not found.
  const Element* find(std::string_view kind, const char* url) const;

 private:
  std::unordered_map<std::string, const Element*> elements_;
};

/// An affine transform: v -> linear * v + translation.
struct AffineTransform {
  Mat3 linear{1};
  Vec3 translation{0, 0, 0};

  AffineTransform operator*(const AffineTransform& b) const {
    return {linear * b.linear, linear * b.translation + translation};
  }
  Vec3 operator*(const Vec3& v) const { return linear * v + translation; }
};

/// An instance of a geometry, possibly through a skin.
struct GeometryInstance {
  const Element* geometry = nullptr;
  const Element* instance = nullptr;  ///< The <instance_geometry> or <instance_controller>.
};

/// A <node> or <visual_scene> of the scene graph.
struct Node {
  AffineTransform transform;                 ///< Transform into the parent's frame.
  std::vector<int> children;                 ///< Child nodes and instanced nodes.
  std::vector<GeometryInstance> geometries;  ///< Instanced geometries.
};

/// The scene graph of a document: acyclic, with a bounded number of node instances.
struct Scene {
  std::vector<Node> nodes;
  int root = 0;  ///< Index of the document's active visual scene.
};
/// Reads the scene graph of a document. [any]
Result<Scene> read_scene(const Element* root, const IdIndex& ids);

/// The triangles of a <geometry> in its own frame.
struct GeometrySoup {
  MeshSoup points;
  std::vector<TexCoord> texcoords;              ///< As many as points; empty: none.
  std::vector<std::string> symbols;             ///< Material symbols, which instances bind to materials.
  std::vector<std::uint32_t> triangle_symbols;  ///< Index into `symbols` for each triangle.
};

/// Reads the triangles of <geometry> elements, each element only once.
class GeometryReader {
 public:
  /// `look`: for reports; null: texture coordinates are not read.
  GeometryReader(const IdIndex& ids, SoupLook* look) : ids_(ids), look_(look) {}

  /// The triangles of a <geometry>; valid as long as this reader.
  Result<const GeometrySoup*> read(const Element* geometry);

 private:
  struct Points {  // view of the points in an array, as an <accessor> describes it
    const std::vector<double>* numbers = nullptr;
    std::size_t offset = 0, stride = 1, count = 0;
    std::array<std::size_t, 3> axis{0, 1, 2};  // positions of x, y and z in a stride
  };
  /// Layout of the index lists of one <triangles>, <polylist> etc.
  struct Layout {
    Points points;
    std::size_t stride = 1;
    std::size_t offset = 0;           // position of the point's index in a stride
    std::optional<Points> texcoords;  // axis: positions of S and T
    std::size_t texcoord_offset = 0;
  };
  /// The corners that an index list names.
  struct Corners {
    std::vector<Vec3> points;
    std::vector<TexCoord> texcoords;  // as many, or none
    void clear() { points.clear(), texcoords.clear(); }
  };

  Result<Layout> layout_of(const Element* primitive, const IdIndex& local_ids);
  void find_texcoords(const Element* primitive, const IdIndex& local_ids, Layout& layout);
  static Result<void> read_indices(const Element* list, const Layout& layout, Corners& corners);
  Result<void> read_concatenated_lists(const Element* primitive, const Layout& layout, GeometrySoup& soup);
  Result<void> read_separate_lists(const Element* primitive, const Layout& layout, GeometrySoup& soup);
  void add_corner(const Corners& corners, std::size_t corner, GeometrySoup& soup);
  void add_polygon(const Corners& corners, std::size_t first, std::size_t count, GeometrySoup& soup);
  void add_strip(const Corners& corners, GeometrySoup& soup);
  void add_fan(const Corners& corners, GeometrySoup& soup);
  Result<const std::vector<double>*> array_of(const Element* source, const Element* accessor, const IdIndex& local_ids);
  Result<Points> view_of(const Element* source, const Element* accessor, const IdIndex& local_ids);
  Result<Points> points_of(const Element* source, const IdIndex& local_ids);
  const Element* source_of(const Element* vertices, const IdIndex& local_ids);

  const IdIndex& ids_;
  SoupLook* look_;
  // shared elements are parsed once, so that the time is linear in the file's size
  std::map<const Element*, GeometrySoup> soups_;
  std::map<const Element*, std::vector<double>> arrays_;
  std::map<const Element*, Points> points_;
  std::map<const Element*, const Element*> sources_;  // by <vertices> element
  std::size_t corners_ = 0;                           // total over all geometries
  PolygonTriangulator triangulator_;
  std::vector<std::size_t> indices_;  // scratch
};

/// Reads <material> elements with the effects and images that they refer to, each only once.
class MaterialReader {
 public:
  MaterialReader(const IdIndex& ids, SoupLook& look) : ids_(ids), look_(look) {}

  /// The materials of a geometry's symbols in this instance, by the symbol's index.
  std::vector<std::uint32_t> bind(const Element* instance, const std::vector<std::string>& symbols);

 private:
  std::uint32_t read(const Element* material);
  void read_shading(const Element* shading, const Element* effect, MeshMaterial& out);
  void read_opacity(const Element* shading, MeshMaterial& out);
  std::string image_of(const Element* texture, const Element* effect);
  Vec3 color_of(const Element* channel, const Vec3& fallback);

  const IdIndex& ids_;
  SoupLook& look_;
  std::map<const Element*, std::uint32_t> known_;
};

}  // namespace limber::model::collada
