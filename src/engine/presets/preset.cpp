// Preset schemas, and the alignment of two presets to a common schema.
#include "engine/presets/preset.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "sim/routes/route_list.h"

namespace limber::engine {

int PresetLayout::find(std::string_view name) const {
  for (std::size_t i = 0; i < properties.size(); i++) {
    if (same_name(properties[i].name, name)) return static_cast<int>(i);
  }
  return -1;
}

std::string PresetSchema::path(std::uint32_t node) const {
  if (node == 0) return "/";
  std::string path;
  for (std::uint32_t at = node; at != 0; at = nodes_[at].parent) path = "/" + escape_name(name(nodes_[at])) + path;
  return path;
}

std::size_t PresetSchema::property_count() const {
  std::size_t count = 0;
  for (const Node& node : nodes_) count += node.layout == kNoLayout ? 0 : layouts_[node.layout]->properties.size();
  return count;
}

bool PresetSchema::operator==(const PresetSchema& other) const {
  const auto same_layout = [&](std::uint32_t a, std::uint32_t b) {
    if (a == kNoLayout || b == kNoLayout) return a == b;
    return layouts_[a] == other.layouts_[b] || *layouts_[a] == *other.layouts_[b];
  };
  return names_ == other.names_ && std::equal(nodes_.begin(), nodes_.end(), other.nodes_.begin(), other.nodes_.end(),
                                              [&](const Node& a, const Node& b) {
                                                return a.parent == b.parent && a.offset == b.offset &&
                                                       a.name_offset == b.name_offset && a.name_size == b.name_size &&
                                                       same_layout(a.layout, b.layout);
                                              });
}

std::uint32_t PresetSchema::add(std::uint32_t parent, std::string_view name) {
  nodes_.push_back(
      {parent, kNoLayout, 0, static_cast<std::uint32_t>(names_.size()), static_cast<std::uint32_t>(name.size())});
  names_ += name;
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void PresetSchema::set_layout(std::uint32_t node, std::uint32_t layout) {
  nodes_[node].layout = layout;
  nodes_[node].offset = value_count_;
  value_count_ += layouts_[layout]->value_count;
}

namespace {

// Key of a node by its parent and name.
std::string node_key(std::uint32_t parent, std::string_view name) { return fmt::format("{}/{}", parent, name); }

}  // namespace

std::vector<std::uint32_t> corresponding_nodes(const PresetSchema& from, const PresetSchema& to) {
  std::unordered_map<std::string, std::uint32_t> targets;
  for (std::uint32_t i = 1; i < to.nodes().size(); i++)
    targets.emplace(node_key(to.nodes()[i].parent, to.name(to.nodes()[i])), i);
  std::vector<std::uint32_t> out(from.nodes().size(), kNoNode);
  out[0] = 0;
  for (std::uint32_t i = 1; i < out.size(); i++) {
    const PresetSchema::Node& node = from.nodes()[i];
    if (out[node.parent] == kNoNode) continue;
    const auto target = targets.find(node_key(out[node.parent], from.name(node)));
    if (target != targets.end()) out[i] = target->second;
  }
  return out;
}

// Returns the node of a path; adds it if it doesn't exist.
std::uint32_t PresetBuilder::node(std::string_view path) {
  while (!path.empty() && path.back() == '/') path.remove_suffix(1);
  if (path.empty()) return 0;
  const std::size_t slash = path.find_last_of('/');
  const std::uint32_t parent = slash == path.npos ? 0 : node(path.substr(0, slash));
  // the same node, however its name is escaped
  const std::string name = unescape_name(path.substr(slash + 1));
  const auto [entry, inserted] = nodes_.try_emplace(node_key(parent, name), 0);
  if (inserted) entry->second = schema_->add(parent, name);
  return entry->second;
}

bool PresetBuilder::add(std::string_view path, PresetLayout layout, const std::vector<double>& values) {
  if (layout.properties.empty()) return true;
  const std::uint32_t index = node(path);
  if (schema_->nodes()[index].layout != PresetSchema::kNoLayout) return false;
  std::string key;
  for (const PresetProperty& property : layout.properties) {
    key += fmt::format("{}\n{} {} {}\n", property.name, static_cast<int>(property.type), property.width,
                       property.labels.size());
    for (const std::string& label : property.labels) key += fmt::format("{} {}\n", label.size(), label);
  }
  const auto [entry, inserted] = layouts_.try_emplace(std::move(key), 0);
  if (inserted) entry->second = schema_->add_layout(std::move(layout));
  schema_->set_layout(index, entry->second);
  values_.insert(values_.end(), values.begin(), values.end());
  return true;
}

bool PresetBuilder::add_route(PresetRoute route) {
  const bool valid = routes_.size() < sim::RouteList::kMaxRoutes && !name_error(route.name) &&
                     route.from.starts_with('/') && route.to.starts_with('/');
  if (!valid || std::ranges::find(routes_, route.name, &PresetRoute::name) != routes_.end()) return false;
  routes_.push_back(std::move(route));
  return true;
}

std::shared_ptr<const Preset> PresetBuilder::finish(std::string name, PresetSelection selection,
                                                    const std::shared_ptr<const PresetSchema>& shared) {
  const bool same = shared != nullptr && *shared == *schema_;
  return std::make_shared<const Preset>(Preset{std::move(name), std::move(selection),
                                               same ? shared : std::move(schema_), std::move(values_),
                                               std::move(routes_)});
}

namespace {

// Reduces two presets to the properties that both have.
class PresetAligner {
 public:
  PresetAligner(const Preset& a, const Preset& b) : a_(a), b_(b) {}

  Blend run() {
    const std::vector<PresetSchema::Node>& nodes = a_.schema->nodes();
    const std::vector<std::uint32_t> node_in_b = corresponding_nodes(*a_.schema, *b_.schema);
    std::vector<std::uint32_t> aligned_node(nodes.size(), 0);
    for (std::uint32_t i = 0; i < nodes.size(); i++) {
      if (node_in_b[i] == kNoNode) continue;
      if (i != 0) aligned_node[i] = schema_->add(aligned_node[nodes[i].parent], a_.schema->name(nodes[i]));
      const PresetSchema::Node& other = b_.schema->nodes()[node_in_b[i]];
      if (a_.schema->layout(nodes[i]) != nullptr && b_.schema->layout(other) != nullptr)
        set_values(aligned_node[i], nodes[i], other);
    }
    return {std::make_shared<const Preset>(Preset{a_.name, a_.selection, schema_, std::move(in_a_), a_.routes}),
            std::make_shared<const Preset>(Preset{b_.name, b_.selection, schema_, std::move(in_b_), b_.routes}), 0};
  }

 private:
  struct CommonLayout {  // properties that two layouts have in common
    struct CommonProperty {
      std::uint32_t a = 0;
      std::uint32_t b = 0;
      std::uint32_t width = 0;
      std::vector<double> labels;  // for each label of b: its index in the merged labels
    };
    std::uint32_t layout = PresetSchema::kNoLayout;
    std::vector<CommonProperty> properties;
  };

  void set_values(std::uint32_t node, const PresetSchema::Node& a, const PresetSchema::Node& b) {
    const CommonLayout& common = common_layout(*a_.schema->layout(a), *b_.schema->layout(b));
    if (common.layout == PresetSchema::kNoLayout) return;
    schema_->set_layout(node, common.layout);
    for (const CommonLayout::CommonProperty& property : common.properties) {
      const double* const in_a = a_.values.data() + a.offset + property.a;
      const double* const in_b = b_.values.data() + b.offset + property.b;
      in_a_.insert(in_a_.end(), in_a, in_a + property.width);
      in_b_.insert(in_b_.end(), in_b, in_b + property.width);
      if (!property.labels.empty()) in_b_.back() = property.labels[static_cast<std::size_t>(in_b[0])];
    }
  }

  const CommonLayout& common_layout(const PresetLayout& a, const PresetLayout& b) {
    const auto [entry, inserted] = common_layouts_.try_emplace({&a, &b});
    CommonLayout& common = entry->second;
    if (!inserted) return common;
    PresetLayout layout;
    for (std::size_t i = 0; i < a.properties.size(); i++) {
      const int at = b.find(a.properties[i].name);
      if (at < 0) continue;
      const PresetProperty& other_property = b.properties[static_cast<std::size_t>(at)];
      PresetProperty property = a.properties[i];
      if (other_property.type != property.type || other_property.width != property.width) continue;
      CommonLayout::CommonProperty common_property{
          a.offsets[i], b.offsets[static_cast<std::size_t>(at)], property.width, {}};
      for (const std::string& label : other_property.labels) {
        auto known_label = std::find(property.labels.begin(), property.labels.end(), label);
        if (known_label == property.labels.end()) known_label = property.labels.insert(property.labels.end(), label);
        common_property.labels.push_back(static_cast<double>(known_label - property.labels.begin()));
      }
      common.properties.push_back(std::move(common_property));
      layout.add(std::move(property));
    }
    if (!layout.properties.empty()) common.layout = schema_->add_layout(std::move(layout));
    return common;
  }

  const Preset& a_;
  const Preset& b_;
  std::shared_ptr<PresetSchema> schema_ = std::make_shared<PresetSchema>();
  std::map<std::pair<const PresetLayout*, const PresetLayout*>, CommonLayout> common_layouts_;
  std::vector<double> in_a_, in_b_;
};

}  // namespace

Blend align(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b) {
  if (a->schema == b->schema) return {a, b, 0};
  if (*a->schema == *b->schema)
    return {a, std::make_shared<const Preset>(Preset{b->name, b->selection, a->schema, b->values, b->routes}), 0};
  return PresetAligner(*a, *b).run();
}

}  // namespace limber::engine
