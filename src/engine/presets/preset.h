// Preset: a named, immutable copy of selected property values, addressed by the paths of their nodes. Reading, mixing
// and saving a preset doesn't need the live world. [any]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "properties/property_table.h"

namespace limber::engine {

/// A property in a preset, identified by its name and the type of its values.
struct PresetProperty {
  std::string name;
  /// One of number, boolean, choice, vec3, flags3, quat; none: another list of numbers.
  PropertyType type = PropertyType::number;
  std::uint32_t width = 1;          ///< Number of values.
  std::vector<std::string> labels;  ///< Of a choice: names of its values; the value is an index.
  bool operator==(const PresetProperty&) const = default;
};

/// A list of properties that is shared by the nodes that have the same ones.
struct PresetLayout {
  std::vector<PresetProperty> properties;
  std::vector<std::uint32_t> offsets;  ///< Offset of each property in the values of a node.
  std::uint32_t value_count = 0;

  void add(PresetProperty property) {
    offsets.push_back(value_count);
    value_count += property.width;
    properties.push_back(std::move(property));
  }
  /// Returns the index of the property of that name, or -1.
  int find(std::string_view name) const;
  bool operator==(const PresetLayout& other) const { return properties == other.properties; }
};

/// The nodes of a preset, and where their values are in Preset::values. Shared by presets of the same nodes and
/// properties.
class PresetSchema {
 public:
  static constexpr std::uint32_t kNoLayout = UINT32_MAX;
  struct Node {
    std::uint32_t parent = 0;
    std::uint32_t layout = kNoLayout;  ///< Index in layouts().
    std::uint32_t offset = 0;          ///< Index of its first value.
    std::uint32_t name_offset = 0;
    std::uint32_t name_size = 0;
  };

  PresetSchema() : nodes_(1) {}

  /// All nodes, parents first; the first is the root. Nodes without properties are only ancestors of others.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::shared_ptr<const PresetLayout>>& layouts() const { return layouts_; }
  const PresetLayout* layout(const Node& node) const {
    return node.layout == kNoLayout ? nullptr : layouts_[node.layout].get();
  }
  std::string_view name(const Node& node) const {
    return std::string_view(names_).substr(node.name_offset, node.name_size);
  }
  /// Returns the path of a node, such as "/physics/body/my%20arm".
  std::string path(std::uint32_t node) const;
  /// Number of values of a preset.
  std::uint32_t value_count() const { return value_count_; }
  std::size_t property_count() const;
  bool operator==(const PresetSchema& other) const;

  // Construction:
  void reserve(std::size_t nodes) { nodes_.reserve(nodes); }
  std::uint32_t add(std::uint32_t parent, std::string_view name);
  /// Sets the properties of a node. Its values follow those of all nodes before.
  void set_layout(std::uint32_t node, std::uint32_t layout);
  std::uint32_t add_layout(PresetLayout layout) {
    layouts_.push_back(std::make_shared<const PresetLayout>(std::move(layout)));
    return static_cast<std::uint32_t>(layouts_.size() - 1);
  }

 private:
  std::vector<Node> nodes_;
  std::vector<std::shared_ptr<const PresetLayout>> layouts_;
  std::string names_;
  std::uint32_t value_count_ = 0;
};

/// Returns for each node of `from` the index of the node of the same path in `to`, or kNoNode.
inline constexpr std::uint32_t kNoNode = UINT32_MAX;
std::vector<std::uint32_t> corresponding_nodes(const PresetSchema& from, const PresetSchema& to);

/// Selects the values of a preset.
struct PresetSelection {
  std::vector<std::string> include;  ///< Patterns of the properties to include; none: all properties.
  std::vector<std::string> except;   ///< Patterns of the properties that a recall doesn't change.
  bool poses = false;                ///< Include positions and rotations of parts.
  bool velocities = false;           ///< Include velocities of parts.
  bool operator==(const PresetSelection&) const = default;
};

/// A route in a preset. Its settings are values, like those of all nodes.
struct PresetRoute {
  std::string name;
  std::string from, to;
  bool operator==(const PresetRoute&) const = default;
};

struct Preset {
  std::string name;
  PresetSelection selection;
  std::shared_ptr<const PresetSchema> schema;
  std::vector<double> values;            ///< schema->value_count() values.
  std::vector<PresetRoute> routes = {};  ///< Those of its schema; a recall adds the ones that do not exist.
};

using PresetList = std::vector<std::shared_ptr<const Preset>>;

/// A preset, or a mix of two presets with the same schema.
struct Blend {
  std::shared_ptr<const Preset> a, b;
  double amount = 0;  ///< Weight of `b`, 0 to 1.

  static Blend of(const std::shared_ptr<const Preset>& preset) { return {preset, preset, 0}; }
};

/// Reduces two presets to the properties that both have, with a common schema.
Blend align(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b);

/// Builds a preset node by node, from paths.
class PresetBuilder {
 public:
  PresetBuilder() : schema_(std::make_shared<PresetSchema>()) {}

  /// Adds a node with its properties, if there are any, and their values. `path` must begin with /. False if the node
  /// has properties already.
  bool add(std::string_view path, PresetLayout layout, const std::vector<double>& values);
  /// Adds a route. False if its name or an address is not valid, the name is in use, or there are too many.
  bool add_route(PresetRoute route);
  /// Returns the preset. `shared`: schema of another preset, which is shared if it is equal; or null.
  std::shared_ptr<const Preset> finish(std::string name, PresetSelection selection,
                                       const std::shared_ptr<const PresetSchema>& shared = nullptr);

 private:
  std::uint32_t node(std::string_view path);

  std::shared_ptr<PresetSchema> schema_;
  std::vector<double> values_;
  std::vector<PresetRoute> routes_;
  std::unordered_map<std::string, std::uint32_t> nodes_;    // by parent and name
  std::unordered_map<std::string, std::uint32_t> layouts_;  // by their content
};

}  // namespace limber::engine
