// Written straight into the text: a tree of a hundred thousand rows would be slow to build as JSON's objects first.
#include "query/tree_json.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "query/row_face.h"

namespace limber {

namespace {

// how many levels of a node's contents have at most kMostRows rows between them
int levels_that_fit(const Tree& tree, std::uint32_t top) {
  std::vector<std::size_t> rows;    // by level: those of nodes so far below the top
  std::vector<std::uint32_t> ends;  // of the nodes that we are in
  for (std::uint32_t at = top; at < tree.nodes()[top].end; at++) {
    while (!ends.empty() && ends.back() <= at) ends.pop_back();
    const std::size_t level = ends.size();
    if (level == rows.size()) rows.push_back(0);
    rows[level] += tree.nodes()[at].table->rows().size() + 1;
    ends.push_back(tree.nodes()[at].end);
  }
  std::size_t sum = 0;
  for (std::size_t level = 0; level < rows.size(); level++) {
    sum += rows[level];
    if (sum > kMostRows && level > 0) return static_cast<int>(level);
  }
  return static_cast<int>(rows.size());
}

class Writer {
 public:
  Writer(const Image& image, std::string& out) : image_(image), tree_(*image.tree), out_(out) {}

  void row(const std::string& path, const TreePlace& place) {
    out_ += R"({"FULL_PATH":)";
    out_ += json_text(path);
    out_ += attributes_text(*place.row);
    if (place.row->kind != RowKind::action) {
      out_ += R"(,"VALUE":)";
      out_ += value_json(*place.row, image_.value(tree_.numbers(place)));
    }
    out_ += '}';
  }

  // `path` has no / at its end, so the root's is empty
  void thing(const std::string& path, std::uint32_t node, int depth) {
    out_ += R"({"FULL_PATH":)";
    out_ += json_text(path.empty() ? "/" : path);
    out_ += R"(,"ACCESS":0,"CONTENTS":{)";
    if (depth > 0) contents(path, node, depth - 1);
    out_ += "}}";
  }

 private:
  void contents(const std::string& path, std::uint32_t node, int depth) {
    const char* comma = "";
    const auto key = [&](std::string_view name) {
      out_ += comma;
      out_ += json_text(name);
      out_ += ':';
      comma = ",";
    };
    for (const Row& r : tree_.nodes()[node].table->rows()) {
      key(r.name);
      row(path + "/" + r.name, {node, &r});
    }
    tree_.each_child(node, [&](std::uint32_t child) {
      const std::string name = escape_name(tree_.name(child));
      key(name);
      thing(path + "/" + name, child, depth);
      return true;
    });
  }

  const Image& image_;
  const Tree& tree_;
  std::string& out_;
};

}  // namespace

std::string node_json(const Image& image, const TreePlace& place, int depth) {
  std::string out;
  Writer writer(image, out);
  const std::string path = image.tree->path(place);
  if (place.row != nullptr) {
    writer.row(path, place);
  } else {
    writer.thing(place.node == 0 ? "" : path, place.node, std::min(depth, levels_that_fit(*image.tree, place.node)));
  }
  return out;
}

std::string find_json(const Image& image, std::string_view words, std::size_t limit) {
  const Tree& tree = *image.tree;
  std::vector<std::string> wanted;
  for (const std::string_view word : split(words, ' ')) {
    if (!word.empty()) wanted.push_back(plain_name(word));
  }
  std::string out = R"({"FOUND":[)";
  Writer writer(image, out);
  std::size_t found = 0;
  for (std::uint32_t node = 0; node < tree.nodes().size() && !wanted.empty() && found <= limit; node++) {
    if (tree.nodes()[node].table->rows().empty()) continue;
    const std::string thing = node == 0 ? "" : tree.path(node);
    const std::string plain = plain_name(thing);
    for (const Row& row : tree.nodes()[node].table->rows()) {
      const std::string whole = plain + "/" + plain_name(row.name);
      const bool hit = std::all_of(wanted.begin(), wanted.end(),
                                   [&](const std::string& word) { return whole.find(word) != std::string::npos; });
      if (!hit || ++found > limit) continue;
      if (found > 1) out += ',';
      writer.row(thing + "/" + row.name, {node, &row});
    }
  }
  return out + fmt::format(R"(],"MORE":{}}})", found > limit);
}

std::string place_value_json(const Image& image, const TreePlace& place) {
  if (place.row == nullptr || place.row->kind == RowKind::action) return "";
  return value_json(*place.row, image.value(image.tree->numbers(place)));
}

}  // namespace limber
