// The node /scene.
#include "script/params_node.h"

#include <algorithm>
#include <array>
#include <optional>

namespace limber {

namespace {

const std::string& label(const Row& row, double value) { return row.choices[static_cast<std::size_t>(value)]; }

bool same_default(const Row& row, const Row& before) {
  if (row.type == RowType::choice) return label(row, row.initial[0]) == label(before, before.initial[0]);
  return std::equal(row.initial.begin(), row.initial.begin() + row.width, before.initial.begin());
}

// the value as it is now; nothing when the default counts
std::optional<std::array<double, 4>> kept_values(const Row& row, const LiveParam& before) {
  if (row.type != before.row.type || !same_default(row, before.row)) return {};
  std::array<double, 4> values{};
  if (row.type == RowType::choice) {
    // a choice is its label, wherever that stands now
    const auto found = std::find(row.choices.begin(), row.choices.end(), label(before.row, before.values[0]));
    if (found == row.choices.end()) return {};
    values[0] = static_cast<double>(found - row.choices.begin());
    return values;
  }
  for (std::size_t i = 0; i < row.width; i++) values[i] = std::clamp(before.values[i], row.low(i), row.high(i));
  return values;
}

}  // namespace

ParamsNode::ParamsNode(Store& store, std::vector<Row> rows)
    : store_(store), id_(store.add(shared_table("scene", "/scene", std::move(rows)), store.root(), "scene", this)) {}

ParamsNode::~ParamsNode() { store_.remove(id_); }

std::vector<LiveParam> ParamsNode::live() const {
  std::vector<LiveParam> params;
  for (const Row& row : table().rows()) {
    LiveParam& param = params.emplace_back(LiveParam{row, {}});
    store_.get(id_, row, param.values.data());
  }
  return params;
}

std::uint64_t ParamsNode::keep(std::span<const LiveParam> before) {
  std::uint64_t defaults = 0;
  for (const Row& row : table().rows()) {
    const auto known =
        std::find_if(before.begin(), before.end(), [&](const LiveParam& p) { return p.row.name == row.name; });
    if (known == before.end()) continue;  // a new one
    const std::optional<std::array<double, 4>> kept = kept_values(row, *known);
    if (!kept) defaults |= std::uint64_t{1} << row.index;
    std::copy_n((kept ? *kept : row.initial).data(), row.width, store_.tell(id_, row));
  }
  return defaults;
}

}  // namespace limber
