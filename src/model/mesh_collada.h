// What the parts of the Collada reader share. Part of the room's inside: only mesh_collada*.cpp includes it.
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
#include "model/mesh_soup.h"

namespace limber::collada {

using Element = tinyxml2::XMLElement;

/// The element that follows in document order below `top`; null at the end. What is inside <extra> and <technique>,
/// where programs write what they like, is left out. [any]
const Element* next_in(const Element* element, const Element* top);
bool is_named(const Element* element, std::string_view name);

/// "line 3: …" of this element. [any]
Error fault_at(const Element* element, std::string_view text);
/// A whole number from 0 to `most`; `missing` without the attribute. [any]
Result<std::size_t> whole_attribute(const Element* element, const char* name, std::size_t missing, std::size_t most);

/// The words of an element's text, comments between them left out.
class ElementWords {
 public:
  explicit ElementWords(const Element* element) : node_(element->FirstChild()), line_(element->GetLineNum()) {}

  /// The next word; empty at the end, and before what is no text: then is_foreign().
  std::string_view next();
  int line() const { return line_; }
  bool is_foreign() const { return foreign_; }

 private:
  const tinyxml2::XMLNode* node_;  // what comes after words_
  MeshWords words_{{}};
  int line_;
  bool foreign_ = false;
};

/// The finite numbers of an element, no fewer than `least`. [any]
Result<std::vector<double>> numbers_of(const Element* element, std::size_t least);

/// Elements by kind and id, below one of them.
class Ids {
 public:
  explicit Ids(const Element* top);
  /// By "#id" or "id"; nodes that have no id of this name by sid and name, too. Null when there is none.
  const Element* find(std::string_view kind, const char* url) const;

 private:
  std::unordered_map<std::string, const Element*> elements_;
};

/// An affine map.
struct Placement {
  Mat3 turn{1};
  Vec3 shift{0, 0, 0};

  Placement operator*(const Placement& b) const { return {turn * b.turn, turn * b.shift + shift}; }
  Vec3 operator*(const Vec3& v) const { return turn * v + shift; }
};

/// A node or a visual scene: where it is in the one above, and what is in it.
struct Node {
  Placement place;
  std::vector<int> below;              ///< Its nodes and instanced nodes.
  std::vector<const Element*> shapes;  ///< Its instanced geometries, those of skins included.
};

/// The nodes of a document: without circles, unfolded no more than a bounded number.
struct Scene {
  std::vector<Node> nodes;
  int start = 0;  ///< The visual scene that is shown.
};
Result<Scene> read_scene(const Element* root, const Ids& ids);

/// Reads geometries, each one once.
class Geometries {
 public:
  explicit Geometries(const Ids& ids) : ids_(ids) {}

  /// The triangles of a <geometry> in its own frame; they live as long as this reader.
  Result<const MeshSoup*> read(const Element* geometry);

 private:
  struct Points {
    const std::vector<double>* numbers = nullptr;
    std::size_t offset = 0, stride = 1, count = 0;
    std::array<std::size_t, 3> axis{0, 1, 2};  // where x, y and z are in a stride
  };
  /// How the index lists of one <triangles>, <polylist> … are to be read.
  struct Layout {
    Points points;
    std::size_t stride = 1;
    std::size_t offset = 0;  // of the corner's point in a stride
  };

  Result<Layout> layout_of(const Element* primitive, const Ids& own);
  static Result<void> read_list(const Element* list, const Layout& layout, std::vector<Vec3>& corners);
  Result<void> read_joined(const Element* primitive, const Layout& layout, MeshSoup& soup);
  Result<void> read_each(const Element* primitive, const Layout& layout, MeshSoup& soup);
  Result<const std::vector<double>*> array_of(const Element* source, const Element* accessor, const Ids& own);
  Result<Points> points_of(const Element* source, const Ids& own);
  const Element* source_of(const Element* vertices, const Ids& own);

  const Ids& ids_;
  // what many may name is read once, so that the time grows with the file's size only
  std::map<const Element*, MeshSoup> soups_;
  std::map<const Element*, std::vector<double>> arrays_;
  std::map<const Element*, Points> points_;
  std::map<const Element*, const Element*> sources_;  // by vertices
  std::size_t corners_ = 0;                           // of all of them
  PolygonCutter cutter_;
};

}  // namespace limber::collada
