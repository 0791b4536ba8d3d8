// PresetBinding: maps the properties of a preset to those of the live world, by name. Skips properties that don't exist
// any more, have another type or are excluded by the preset. [sim]
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "engine/presets/preset.h"
#include "properties/interpolate.h"
#include "properties/store.h"

namespace limber::engine {

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

/// Calls f(node, property, values) for each value of the blend that applies to the world, in the order of the binding.
template <class F>
void for_each_value(const PresetBinding& binding, const Blend& blend, F&& f) {
  std::array<double, 4> a{};
  std::array<double, 4> b{};
  for (const PresetBinding::Node& node : binding.nodes()) {
    for (const PresetBinding::BoundProperty& bound : binding.layout(node).properties) {
      if ((node.excluded >> bound.property->index & 1u) != 0) continue;
      if (!PresetBinding::read(bound, blend.a->values.data() + node.offset, a.data())) continue;
      if (blend.amount > 0) {
        if (!PresetBinding::read(bound, blend.b->values.data() + node.offset, b.data())) continue;
        mix(*bound.property, a.data(), b.data(), blend.amount, a.data());
      }
      f(node, *bound.property, a.data());
    }
  }
}

// Compares bit by bit. Inline: for up to four values a call would cost more than the comparison.
inline bool same_bits(const double* a, const double* b, std::size_t count) {
  for (std::size_t i = 0; i < count; i++) {
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  }
  return true;
}

/// Values that could not be applied unchanged.
struct RecallResult {
  std::size_t clamped = 0;  ///< Outside the current range of the property.
  std::size_t rejected = 0;
  std::string first_problem;  ///< Path of the first one of both, with the reason.
};

/// Describes values that stay unchanged because their property has lost that choice; empty if there are none.
std::string missing_choices(const Store& store, const PresetBinding& binding, const Blend& blend);

/// Applies the blend at once. Values that are equal already are not written, so that they cause no on-change callbacks.
RecallResult recall(Store& store, const PresetBinding& binding, const Blend& blend);

}  // namespace limber::engine
