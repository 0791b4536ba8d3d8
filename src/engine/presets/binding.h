// PresetBinding: maps the properties of a preset to those of the live world, by name. Skips properties that don't exist
// any more, have another type or are excluded by the preset. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"
#include "properties/store.h"

namespace limber {

class PresetBinding {
 public:
  /// A property of the preset that the live node still has.
  struct BoundProperty {
    const Property* property = nullptr;
    const PresetProperty* source = nullptr;
    std::uint32_t offset = 0;        ///< Offset in the values of the node.
    std::vector<double> choice_map;  ///< Of a choice: live value for each label of the preset; −1: no such choice.
  };
  /// Mapping of a layout to the properties of a node type.
  struct LayoutBinding {
    const PresetLayout* source = nullptr;
    const PropertyTable* table = nullptr;
    std::vector<BoundProperty> properties;
    std::vector<std::uint32_t> incomplete_choices;  ///< Indices of choices that lack a label of the preset.
    std::string first_mismatch;                     ///< Name of the first property without a match.
    std::size_t mismatches = 0;
  };
  struct Node {
    NodeId id;
    std::uint32_t index = 0;     ///< Index in the nodes of the preset.
    std::uint32_t layout = 0;    ///< Index of its LayoutBinding.
    std::uint32_t offset = 0;    ///< Index of its first value.
    std::uint64_t excluded = 0;  ///< Excluded properties, one bit each.
  };

  /// Binds a preset's schema. `of_everything`: the preset should contain all properties, so new ones are reported in
  /// omissions(). Error: a pattern in `except` is invalid.
  static Result<std::shared_ptr<const PresetBinding>> make(const Store& store,
                                                           std::shared_ptr<const PresetSchema> schema,
                                                           std::span<const std::string> except, bool of_everything);

  /// True if the binding is still valid: no node was added or removed since.
  bool up_to_date(const Store& store) const { return structure_version_ == store.structure_version(); }
  const std::shared_ptr<const PresetSchema>& schema() const { return schema_; }
  const std::vector<std::string>& except() const { return except_; }
  /// Behavior groups first, since writes to them are forwarded to their members; then in the order of the preset.
  const std::vector<Node>& nodes() const { return nodes_; }
  const LayoutBinding& layout(const Node& node) const { return layouts_[node.layout]; }
  /// Describes skipped and missing properties: empty, or "2 objects were not found (/physics/body/arm, …); …".
  const std::string& omissions() const { return omissions_; }

  /// Reads the values of a property from those of its node in the preset. False if it has no such choice.
  static bool read(const BoundProperty& property, const double* values, double* out);

 private:
  class Builder;

  std::uint64_t structure_version_ = 0;
  std::shared_ptr<const PresetSchema> schema_;
  std::vector<std::string> except_;
  std::vector<Node> nodes_;
  std::vector<LayoutBinding> layouts_;
  std::string omissions_;
};

}  // namespace limber
