// The node /scene and the values carried over by a reload.
#include "script/api/params_node.h"

#include <algorithm>
#include <array>
#include <optional>

namespace limber::script {

namespace {

const std::string& label(const Property& property, double value) {
  return property.choices[static_cast<std::size_t>(value)];
}

bool same_default(const Property& property, const Property& previous) {
  if (property.type == PropertyType::choice)
    return label(property, property.initial[0]) == label(previous, previous.initial[0]);
  return std::equal(property.initial.begin(), property.initial.begin() + property.width, previous.initial.begin());
}

// the current value; nothing if the default applies
std::optional<std::array<double, 4>> carried_values(const Property& property, const LiveParam& previous) {
  if (property.type != previous.property.type || !same_default(property, previous.property)) return {};
  std::array<double, 4> values{};
  if (property.type == PropertyType::choice) {
    // choices are identified by label; their index may have changed
    const auto found =
        std::find(property.choices.begin(), property.choices.end(), label(previous.property, previous.values[0]));
    if (found == property.choices.end()) return {};
    values[0] = static_cast<double>(found - property.choices.begin());
    return values;
  }
  for (std::size_t i = 0; i < property.width; i++)
    values[i] = std::clamp(previous.values[i], property.low(i), property.high(i));
  return values;
}

}  // namespace

ParamsNode::ParamsNode(Store& store, std::vector<Property> properties)
    : store_(store),
      id_(store.add(shared_table("scene", "/scene", std::move(properties)), store.root(), "scene", this)) {}

ParamsNode::~ParamsNode() { store_.remove(id_); }

std::vector<LiveParam> ParamsNode::values() const {
  std::vector<LiveParam> params;
  for (const Property& property : table().properties()) {
    LiveParam& param = params.emplace_back(LiveParam{property, {}});
    store_.get(id_, property, param.values.data());
  }
  return params;
}

std::uint64_t ParamsNode::carry_over(std::span<const LiveParam> previous) {
  std::uint64_t defaults = 0;
  for (const Property& property : table().properties()) {
    const auto known = std::find_if(previous.begin(), previous.end(),
                                    [&](const LiveParam& p) { return p.property.name == property.name; });
    if (known == previous.end()) continue;  // a new parameter
    const std::optional<std::array<double, 4>> carried = carried_values(property, *known);
    if (!carried) defaults |= std::uint64_t{1} << property.index;
    std::copy_n((carried ? *carried : property.initial).data(), property.width, store_.mutable_values(id_, property));
  }
  return defaults;
}

}  // namespace limber::script
