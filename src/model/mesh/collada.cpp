// Collada reader: the document, words and ids, and collecting the triangles of the scene graph.
#include "model/mesh/collada.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh/load.h"
#include "model/problems.h"
#include "model/xml_text.h"

namespace limber::model::collada {

const Element* next_element(const Element* element, const Element* top) {
  const bool skip_children = is_named(element, "extra") || is_named(element, "technique");
  const Element* child = skip_children ? nullptr : element->FirstChildElement();
  if (child) return child;
  while (element != top) {
    if (const Element* sibling = element->NextSiblingElement()) return sibling;
    element = element->Parent()->ToElement();
  }
  return nullptr;
}

bool is_named(const Element* element, std::string_view name) { return element->Name() == name; }

Error error_at(const Element* element, std::string_view text) { return mesh_error(element->GetLineNum(), text); }

Result<std::size_t> integer_attribute(const Element* element, const char* name, std::size_t fallback,
                                      std::size_t max_value) {
  const char* text = element->Attribute(name);
  if (!text) return fallback;
  const std::optional<std::int64_t> value = parse_integer(text);
  if (value && *value >= 0 && static_cast<std::size_t>(*value) <= max_value) return static_cast<std::size_t>(*value);
  return error_at(element, fmt::format("{}={} is invalid", name, quoted_word(text)));
}

std::string_view ElementTokenizer::next() {
  while (true) {
    const std::string_view word = tokenizer_.next();
    if (!word.empty()) {
      line_ = tokenizer_.line();
      return word;
    }
    if (!node_) return {};
    const tinyxml2::XMLText* text = node_->ToText();
    if (text ? text->CData() : !node_->ToComment()) {
      line_ = node_->GetLineNum();
      found_non_text_ = true;
      return {};
    }
    if (text) {
      // tinyxml2 reports the line of the first non-blank character
      std::string_view value = text->Value();
      value.remove_prefix(std::min(value.find_first_not_of(" \t\r\n"), value.size()));
      tokenizer_ = MeshTokenizer(value, text->GetLineNum());
    }
    node_ = node_->NextSibling();
  }
}

namespace {

/// Parses a finite number. Some exporters write numbers in the user's locale (0,01): a single comma is accepted as the
/// decimal point.
std::optional<double> parse_decimal(std::string_view word) {
  const std::optional<double> number = parse_number(word);
  const std::size_t comma = word.find(',');
  if (number || comma == std::string_view::npos || word.find('.') != std::string_view::npos) return number;
  std::string with_point(word);
  with_point[comma] = '.';
  return parse_number(with_point);
}

}  // namespace

Result<std::vector<double>> numbers_of(const Element* element, std::size_t min_count) {
  std::vector<double> numbers;
  ElementTokenizer words(element);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const std::optional<double> number = parse_decimal(word);
    if (!number) return mesh_error(words.line(), fmt::format("{} is not a finite number", quoted_word(word)));
    numbers.push_back(*number);
  }
  if (words.found_non_text())
    return mesh_error(words.line(), fmt::format("<{}> must contain numbers only", element->Name()));
  if (numbers.size() >= min_count) return numbers;
  return error_at(element,
                  fmt::format("<{}> contains {} numbers, expected {}", element->Name(), numbers.size(), min_count));
}

IdIndex::IdIndex(const Element* top) {
  constexpr std::array<std::string_view, 10> kKinds{"geometry", "controller",   "source", "float_array", "vertices",
                                                    "node",     "visual_scene", "image",  "effect",      "material"};
  // the first element with a key wins; ids take precedence over sids and names
  for (const char* key : {"id", "sid", "name"}) {
    for (const Element* e = top; e; e = next_element(e, top)) {
      const std::string_view kind = e->Name();
      if (key == std::string_view("id") ? std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()
                                        : kind != "node")
        continue;
      if (const char* id = e->Attribute(key)) elements_.emplace(fmt::format("{}#{}", kind, id), e);
    }
  }
}

const Element* IdIndex::find(std::string_view kind, const char* url) const {
  if (!url) return nullptr;
  const auto found = elements_.find(fmt::format("{}#{}", kind, *url == '#' ? url + 1 : url));
  return found == elements_.end() ? nullptr : found->second;
}

namespace {

Result<AffineTransform> unit_scale(const Element* root) {
  const Element* asset = root->FirstChildElement("asset");
  const Element* unit = asset ? asset->FirstChildElement("unit") : nullptr;
  const char* text = unit ? unit->Attribute("meter") : nullptr;
  if (!text) return AffineTransform{};
  const std::optional<double> meter = parse_decimal(text);
  if (meter && *meter > 0) return AffineTransform{Mat3(*meter), Vec3(0)};
  return error_at(unit, fmt::format("meter={} is invalid", quoted_word(text)));
}

/// Appends triangles to the result; `materials`: of the geometry's symbols.
void append(const GeometrySoup& from, const AffineTransform& transform, const std::vector<std::uint32_t>& materials,
            MeshSoup& to, SoupLook* look) {
  const bool flipped = glm::determinant(transform.linear) < 0;
  for (std::size_t i = 0; i + 2 < from.points.size(); i += 3) {
    for (const std::size_t k : {i, flipped ? i + 2 : i + 1, flipped ? i + 1 : i + 2}) {
      if (look != nullptr && !from.texcoords.empty()) look->set_texcoord(to.size(), from.texcoords[k]);
      to.push_back(transform * from.points[k]);
    }
    if (look != nullptr) look->paint(to.size(), materials[from.triangle_symbols[i / 3]]);
  }
}

Result<MeshSoup> collect_triangles(const Scene& scene, const AffineTransform& unit, GeometryReader& geometries,
                                   MaterialReader* materials, SoupLook* look) {
  MeshSoup soup;
  std::vector<std::pair<int, AffineTransform>> stack{{scene.root, unit}};
  while (!stack.empty()) {
    const auto [index, parent_transform] = stack.back();
    stack.pop_back();
    const Node& node = scene.nodes[static_cast<std::size_t>(index)];
    const AffineTransform transform = parent_transform * node.transform;
    for (const GeometryInstance& instance : node.geometries) {
      const Result<const GeometrySoup*> triangles = geometries.read(instance.geometry);
      if (!triangles) return Error{triangles.error()};
      if (soup.size() + (*triangles)->points.size() > 3 * kMaxMeshTriangles) return too_many_triangles();
      std::vector<std::uint32_t> bound;
      if (materials != nullptr) bound = materials->bind(instance.instance, (*triangles)->symbols);
      append(**triangles, transform, bound, soup, look);
    }
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      stack.emplace_back(*child, transform);
  }
  return soup;
}

}  // namespace

}  // namespace limber::model::collada

namespace limber::model {

Result<MeshSoup> soup_from_collada(std::string_view bytes, SoupLook* look) {
  if (bytes.size() > kMaxUrdfBytes) {
    return Error{fmt::format("has {} bytes; Collada files must have at most {}. Export it as binary STL.", bytes.size(),
                             kMaxUrdfBytes)};
  }
  Problems problems;
  const Result<std::string> text = clean_urdf_text(bytes, problems);
  if (!text) return Error{"is not a Collada file. Export it again, or as binary STL."};
  for (const Problem& p : problems.list()) {
    if (p.severity == Severity::error) return mesh_error(p.line, p.text);
  }
  tinyxml2::XMLDocument document;
  document.Parse(text->data(), text->size());
  const tinyxml2::XMLElement* root = document.RootElement();
  if (document.Error() || !root || !collada::is_named(root, "COLLADA")) {
    return mesh_error(document.Error() ? document.ErrorLineNum() : 1, "the XML is not a Collada document");
  }
  const Result<collada::AffineTransform> unit = collada::unit_scale(root);
  if (!unit) return Error{unit.error()};
  const collada::IdIndex ids(root);
  const Result<collada::Scene> scene = collada::read_scene(root, ids);
  if (!scene) return Error{scene.error()};
  collada::GeometryReader geometries(ids, look);
  std::optional<collada::MaterialReader> materials;
  if (look != nullptr) materials.emplace(ids, *look);
  return collada::collect_triangles(*scene, *unit, geometries, materials ? &*materials : nullptr, look);
}

}  // namespace limber::model
