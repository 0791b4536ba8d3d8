// Checks and thins out a Collada document before assimp sees it.
#include "model/mesh_collada.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "base/text.h"
#include "model/problems.h"
#include "model/urdf_text.h"

namespace limber {

namespace {

using tinyxml2::XMLElement;

constexpr std::array<std::string_view, 5> kLibraries{"asset", "library_geometries", "library_nodes",
                                                     "library_visual_scenes", "scene"};
constexpr std::array<std::string_view, 3> kNeedless{"extra", "bind_material", "technique"};
constexpr std::array<std::string_view, 5> kIndexLists{"p", "h", "v", "vcount", "ph"};
constexpr std::uint64_t kMostNodes = 10'000;
constexpr const char* kCure = "Export it again, or as binary STL.";

template <std::size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The element that follows in document order, below `top`.
XMLElement* next_in(XMLElement* element, const XMLElement* top) {
  if (XMLElement* child = element->FirstChildElement()) return child;
  while (element != top) {
    if (XMLElement* sibling = element->NextSiblingElement()) return sibling;
    element = element->Parent()->ToElement();
  }
  return nullptr;
}

void thin_out(tinyxml2::XMLDocument& document, XMLElement* root) {
  std::vector<XMLElement*> needless;
  for (XMLElement* e = root->FirstChildElement(); e; e = e->NextSiblingElement()) {
    if (!is_one_of(e->Name(), kLibraries)) needless.push_back(e);
  }
  for (XMLElement* e : needless) document.DeleteNode(e);
  needless.clear();
  for (XMLElement* e = root; e;) {
    const bool drop = is_one_of(e->Name(), kNeedless);
    if (drop) needless.push_back(e);
    // what is below a dropped element goes with it
    XMLElement* next = drop ? e->NextSiblingElement() : next_in(e, root);
    XMLElement* up = e;
    while (drop && !next && up != root) {
      up = up->Parent()->ToElement();
      next = up == root ? nullptr : up->NextSiblingElement();
    }
    e = next;
  }
  for (XMLElement* e : needless) document.DeleteNode(e);
}

/// Index lists hold integers only, and no list is longer than the file.
std::string list_fault(XMLElement* root, std::size_t size) {
  for (XMLElement* e = root; e; e = next_in(e, root)) {
    for (const char* attribute : {"count", "stride", "offset", "set"}) {
      const char* text = e->Attribute(attribute);
      if (!text) continue;
      const std::optional<double> value = parse_number(text);
      const double most = std::string_view(attribute) == "count" ? static_cast<double>(size) : 1000.0;
      if (value && *value >= 0 && *value <= most) continue;
      return fmt::format("line {}: {}='{}' can't be", e->GetLineNum(), attribute,
                         printable(std::string_view(text).substr(0, 20)));
    }
    if (!is_one_of(e->Name(), kIndexLists)) continue;
    for (const tinyxml2::XMLNode* node = e->FirstChild(); node; node = node->NextSibling()) {
      const tinyxml2::XMLText* text = node->ToText();
      const bool good =
          text && !text->CData() &&
          std::string_view(text->Value()).find_first_not_of("0123456789+- \t\r\n") == std::string_view::npos;
      if (!good && !node->ToComment()) {
        return fmt::format("line {}: <{}> holds more than whole numbers", node->GetLineNum(), e->Name());
      }
    }
  }
  return {};
}

/// Nodes and what they instance, as a graph: it must have no circle and unfold to a bounded number of nodes.
class Nodes {
 public:
  explicit Nodes(XMLElement* root) {
    for (XMLElement* e = root; e; e = next_in(e, root)) {
      if (std::string_view(e->Name()) != "node") continue;
      number_[e] = static_cast<int>(below_.size());
      below_.emplace_back();
      for (const char* key : {"id", "sid", "name"}) {
        if (const char* name = e->Attribute(key)) named_[name].push_back(number_[e]);
      }
    }
    for (XMLElement* e = root; e; e = next_in(e, root)) connect(e);
  }

  std::string fault() {
    count_.assign(below_.size(), 0);
    open_.assign(below_.size(), false);
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < below_.size(); ++i) {
      if (!unfold(static_cast<int>(i))) return "its nodes instance each other in a circle";
      total = std::max(total, count_[i]);
    }
    return total > kMostNodes ? fmt::format("its nodes unfold to more than {}", kMostNodes) : "";
  }

 private:
  void connect(XMLElement* e) {
    const std::string_view kind = e->Name();
    if (kind != "node" && kind != "instance_node") return;
    const tinyxml2::XMLNode* up = e->Parent();
    const auto parent = up && up->ToElement() ? number_.find(up->ToElement()) : number_.end();
    if (parent == number_.end()) return;
    std::vector<int>& below = below_[static_cast<std::size_t>(parent->second)];
    if (kind == "node") {
      below.push_back(number_[e]);
    } else if (const char* url = e->Attribute("url")) {
      const auto found = named_.find(*url == '#' ? url + 1 : url);
      if (found != named_.end()) below.insert(below.end(), found->second.begin(), found->second.end());
    }
  }

  /// Counts the nodes that one stands for; false for a circle. Without recursion.
  bool unfold(int start) {
    std::vector<std::pair<int, std::size_t>> stack{{start, 0}};
    while (!stack.empty()) {
      auto& [node, next] = stack.back();
      const auto at = static_cast<std::size_t>(node);
      if (count_[at] > 0) {
        stack.pop_back();
        continue;
      }
      open_[at] = true;
      if (next < below_[at].size()) {
        const int child = below_[at][next++];
        if (open_[static_cast<std::size_t>(child)]) return false;
        stack.emplace_back(child, 0);
        continue;
      }
      std::uint64_t sum = 1;
      for (const int child : below_[at]) sum = std::min(sum + count_[static_cast<std::size_t>(child)], 2 * kMostNodes);
      count_[at] = sum;
      open_[at] = false;
      stack.pop_back();
    }
    return true;
  }

  std::map<const XMLElement*, int> number_;
  std::map<std::string, std::vector<int>, std::less<>> named_;
  std::vector<std::vector<int>> below_;
  std::vector<std::uint64_t> count_;
  std::vector<bool> open_;
};

}  // namespace

Result<std::string> clean_collada(std::string_view bytes) {
  Problems problems;
  const Result<std::string> text = clean_urdf_text(bytes, problems);
  if (!text) return Error{"is no Collada text. Export it again, or as binary STL."};
  for (const Problem& p : problems.list()) {
    if (p.severity == Severity::error) return Error{fmt::format("line {}: {}. {}", p.line, p.text, kCure)};
  }
  tinyxml2::XMLDocument document;
  document.Parse(text->data(), text->size());
  XMLElement* root = document.RootElement();
  if (document.Error() || !root || std::string_view(root->Name()) != "COLLADA") {
    return Error{fmt::format("line {}: the XML is no Collada document. {}", document.ErrorLineNum(), kCure)};
  }
  thin_out(document, root);
  std::string fault = list_fault(root, bytes.size());
  if (fault.empty()) fault = Nodes(root).fault();
  if (!fault.empty()) return Error{fmt::format("{}. {}", fault, kCure)};
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  return std::string(printer.CStr(), static_cast<std::size_t>(printer.CStrSize() - 1));
}

}  // namespace limber
