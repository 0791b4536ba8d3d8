// Writes JSON text directly: building JSON objects first would be slow for a tree of a hundred thousand properties.
#include "net/oscquery/tree_json.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "net/oscquery/attributes.h"

namespace limber::oscquery {

namespace {

// Returns the number of levels below a node that contain at most kMaxProperties properties in total.
int max_levels(const TreeSnapshot& tree, std::uint32_t top) {
  std::vector<std::size_t> counts;  // number of properties by level below the top
  std::vector<std::uint32_t> ends;  // end indices of the enclosing nodes
  for (std::uint32_t at = top; at < tree.nodes()[top].subtree_end; at++) {
    while (!ends.empty() && ends.back() <= at) ends.pop_back();
    const std::size_t level = ends.size();
    if (level == counts.size()) counts.push_back(0);
    counts[level] += tree.nodes()[at].table->properties().size() + 1;
    ends.push_back(tree.nodes()[at].subtree_end);
  }
  std::size_t sum = 0;
  for (std::size_t level = 0; level < counts.size(); level++) {
    sum += counts[level];
    if (sum > kMaxProperties && level > 0) return static_cast<int>(level);
  }
  return static_cast<int>(counts.size());
}

class Writer {
 public:
  Writer(const engine::ValueSnapshot& snapshot, std::string& out)
      : snapshot_(snapshot), tree_(*snapshot.tree), out_(out) {}

  void write_property(const std::string& path, const TreePropertyRef& ref) {
    out_ += R"({"FULL_PATH":)";
    out_ += json_text(path);
    out_ += attributes_text(*ref.property);
    if (ref.property->kind != PropertyKind::action) {
      out_ += R"(,"VALUE":)";
      out_ += value_json(*ref.property, snapshot_.value(tree_.location(ref)));
    }
    out_ += '}';
  }

  // `path` has no trailing slash, so the root's is empty.
  void write_node(const std::string& path, std::uint32_t node, int depth) {
    out_ += R"({"FULL_PATH":)";
    out_ += json_text(path.empty() ? "/" : path);
    out_ += R"(,"ACCESS":0,"CONTENTS":{)";
    if (depth > 0) write_contents(path, node, depth - 1);
    out_ += "}}";
  }

 private:
  void write_contents(const std::string& path, std::uint32_t node, int depth) {
    const char* comma = "";
    const auto key = [&](std::string_view name) {
      out_ += comma;
      out_ += json_text(name);
      out_ += ':';
      comma = ",";
    };
    for (const Property& r : tree_.nodes()[node].table->properties()) {
      key(r.name);
      write_property(path + "/" + r.name, {node, &r});
    }
    tree_.each_child(node, [&](std::uint32_t child) {
      const std::string name = escape_name(tree_.name(child));
      key(name);
      write_node(path + "/" + name, child, depth);
      return true;
    });
  }

  const engine::ValueSnapshot& snapshot_;
  const TreeSnapshot& tree_;
  std::string& out_;
};

}  // namespace

std::string node_json(const engine::ValueSnapshot& snapshot, const TreePropertyRef& ref, int depth) {
  std::string out;
  Writer writer(snapshot, out);
  const std::string path = snapshot.tree->path(ref);
  if (ref.property != nullptr) {
    writer.write_property(path, ref);
  } else {
    writer.write_node(ref.node == 0 ? "" : path, ref.node, std::min(depth, max_levels(*snapshot.tree, ref.node)));
  }
  return out;
}

std::string find_json(const engine::ValueSnapshot& snapshot, std::string_view words, std::size_t limit) {
  const TreeSnapshot& tree = *snapshot.tree;
  std::vector<std::string> normalized;
  for (const std::string_view word : split(words, ' ')) {
    if (!word.empty()) normalized.push_back(normalized_name(word));
  }
  std::string out = R"({"FOUND":[)";
  Writer writer(snapshot, out);
  std::size_t found = 0;
  for (std::uint32_t node = 0; node < tree.nodes().size() && !normalized.empty() && found <= limit; node++) {
    if (tree.nodes()[node].table->properties().empty()) continue;
    const std::string object = node == 0 ? "" : tree.path(node);
    const std::string plain = normalized_name(object);
    for (const Property& property : tree.nodes()[node].table->properties()) {
      const std::string property_path = plain + "/" + normalized_name(property.name);
      const bool matches = std::all_of(normalized.begin(), normalized.end(), [&](const std::string& word) {
        return property_path.find(word) != std::string::npos;
      });
      if (!matches || ++found > limit) continue;
      if (found > 1) out += ',';
      writer.write_property(object + "/" + property.name, {node, &property});
    }
  }
  return out + fmt::format(R"(],"MORE":{}}})", found > limit);
}

std::string property_value_json(const engine::ValueSnapshot& snapshot, const TreePropertyRef& ref) {
  if (ref.property == nullptr || ref.property->kind == PropertyKind::action) return "";
  return value_json(*ref.property, snapshot.value(snapshot.tree->location(ref)));
}

}  // namespace limber::oscquery
