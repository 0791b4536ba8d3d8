// Reads Collada: the document, its words and ids, and the walk through its scene.
#include "model/mesh_collada.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"
#include "model/mesh_load.h"
#include "model/problems.h"
#include "model/urdf_text.h"

namespace limber::collada {

const Element* next_in(const Element* element, const Element* top) {
  const bool closed = is_named(element, "extra") || is_named(element, "technique");
  const Element* child = closed ? nullptr : element->FirstChildElement();
  if (child) return child;
  while (element != top) {
    if (const Element* sibling = element->NextSiblingElement()) return sibling;
    element = element->Parent()->ToElement();
  }
  return nullptr;
}

bool is_named(const Element* element, std::string_view name) { return element->Name() == name; }

Error fault_at(const Element* element, std::string_view text) { return mesh_fault(element->GetLineNum(), text); }

Result<std::size_t> whole_attribute(const Element* element, const char* name, std::size_t missing, std::size_t most) {
  const char* text = element->Attribute(name);
  if (!text) return missing;
  const std::optional<std::int64_t> value = parse_whole(text);
  if (value && *value >= 0 && static_cast<std::size_t>(*value) <= most) return static_cast<std::size_t>(*value);
  return fault_at(element, fmt::format("{}={} can't be", name, quoted_word(text)));
}

std::string_view ElementWords::next() {
  while (true) {
    const std::string_view word = words_.next();
    if (!word.empty()) {
      line_ = words_.line();
      return word;
    }
    if (!node_) return {};
    const tinyxml2::XMLText* text = node_->ToText();
    if (text ? text->CData() : !node_->ToComment()) {
      line_ = node_->GetLineNum();
      foreign_ = true;
      return {};
    }
    if (text) {
      // a text's line is that of its first character which is no blank
      std::string_view value = text->Value();
      value.remove_prefix(std::min(value.find_first_not_of(" \t\r\n"), value.size()));
      words_ = MeshWords(value, text->GetLineNum());
    }
    node_ = node_->NextSibling();
  }
}

namespace {

/// A finite number. Some exporters write all of a file as their country does, 0,01: one comma is a point.
std::optional<double> number_in(std::string_view word) {
  const std::optional<double> number = parse_number(word);
  const std::size_t comma = word.find(',');
  if (number || comma == std::string_view::npos || word.find('.') != std::string_view::npos) return number;
  std::string pointed(word);
  pointed[comma] = '.';
  return parse_number(pointed);
}

}  // namespace

Result<std::vector<double>> numbers_of(const Element* element, std::size_t least) {
  std::vector<double> numbers;
  ElementWords words(element);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const std::optional<double> number = number_in(word);
    if (!number) return mesh_fault(words.line(), fmt::format("{} is no finite number", quoted_word(word)));
    numbers.push_back(*number);
  }
  if (words.is_foreign()) return mesh_fault(words.line(), fmt::format("<{}> holds more than numbers", element->Name()));
  if (numbers.size() >= least) return numbers;
  return fault_at(element, fmt::format("<{}> holds {} numbers, not {}", element->Name(), numbers.size(), least));
}

Ids::Ids(const Element* top) {
  constexpr std::array<std::string_view, 7> kKinds{"geometry", "controller", "source",      "float_array",
                                                   "vertices", "node",       "visual_scene"};
  // the first of a name counts, and an id more than other names
  for (const char* key : {"id", "sid", "name"}) {
    for (const Element* e = top; e; e = next_in(e, top)) {
      const std::string_view kind = e->Name();
      if (key == std::string_view("id") ? std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()
                                        : kind != "node")
        continue;
      if (const char* id = e->Attribute(key)) elements_.emplace(fmt::format("{}#{}", kind, id), e);
    }
  }
}

const Element* Ids::find(std::string_view kind, const char* url) const {
  if (!url) return nullptr;
  const auto found = elements_.find(fmt::format("{}#{}", kind, *url == '#' ? url + 1 : url));
  return found == elements_.end() ? nullptr : found->second;
}

namespace {

Result<Placement> unit_of(const Element* root) {
  const Element* asset = root->FirstChildElement("asset");
  const Element* unit = asset ? asset->FirstChildElement("unit") : nullptr;
  const char* text = unit ? unit->Attribute("meter") : nullptr;
  if (!text) return Placement{};
  const std::optional<double> meter = number_in(text);
  if (meter && *meter > 0) return Placement{Mat3(*meter), Vec3(0)};
  return fault_at(unit, fmt::format("meter={} can't be", quoted_word(text)));
}

void append(const MeshSoup& from, const Placement& place, MeshSoup& to) {
  const bool flipped = glm::determinant(place.turn) < 0;
  for (std::size_t i = 0; i + 2 < from.size(); i += 3) {
    const Vec3 b = place * from[i + 1], c = place * from[i + 2];
    to.insert(to.end(), {place * from[i], flipped ? c : b, flipped ? b : c});
  }
}

Result<MeshSoup> walk(const Scene& scene, const Placement& unit, Geometries& geometries) {
  MeshSoup soup;
  std::vector<std::pair<int, Placement>> open{{scene.start, unit}};
  while (!open.empty()) {
    const auto [index, above] = open.back();
    open.pop_back();
    const Node& node = scene.nodes[static_cast<std::size_t>(index)];
    const Placement place = above * node.place;
    for (const Element* shape : node.shapes) {
      const Result<const MeshSoup*> triangles = geometries.read(shape);
      if (!triangles) return Error{triangles.error()};
      if (soup.size() + (*triangles)->size() > 3 * kMostMeshTriangles) return too_many_triangles();
      append(**triangles, place, soup);
    }
    for (auto below = node.below.rbegin(); below != node.below.rend(); ++below) open.emplace_back(*below, place);
  }
  return soup;
}

}  // namespace

}  // namespace limber::collada

namespace limber {

Result<MeshSoup> soup_from_collada(std::string_view bytes) {
  if (bytes.size() > kMostUrdfBytes) {
    return Error{fmt::format("has {} bytes; of Collada, at most {} are read. Export it as binary STL.", bytes.size(),
                             kMostUrdfBytes)};
  }
  Problems problems;
  const Result<std::string> text = clean_urdf_text(bytes, problems);
  if (!text) return Error{"is no Collada text. Export it again, or as binary STL."};
  for (const Problem& p : problems.list()) {
    if (p.severity == Severity::error) return mesh_fault(p.line, p.text);
  }
  tinyxml2::XMLDocument document;
  document.Parse(text->data(), text->size());
  const tinyxml2::XMLElement* root = document.RootElement();
  if (document.Error() || !root || !collada::is_named(root, "COLLADA")) {
    return mesh_fault(document.Error() ? document.ErrorLineNum() : 1, "the XML is no Collada document");
  }
  const Result<collada::Placement> unit = collada::unit_of(root);
  if (!unit) return Error{unit.error()};
  const collada::Ids ids(root);
  const Result<collada::Scene> scene = collada::read_scene(root, ids);
  if (!scene) return Error{scene.error()};
  collada::Geometries geometries(ids);
  return collada::walk(*scene, *unit, geometries);
}

}  // namespace limber
