// The node /scene, and tables that outlive it.
#include "script/params_node.h"

#include <algorithm>
#include <memory>
#include <mutex>

namespace limber {

namespace {

bool same_row(const Row& a, const Row& b) {
  return a.name == b.name && a.type == b.type && a.unit == b.unit && a.min == b.min && a.max == b.max &&
         a.axis_min == b.axis_min && a.axis_max == b.axis_max && a.step == b.step && a.initial == b.initial &&
         a.doc == b.doc && a.choices == b.choices;
}

// stores number tables by address and keep them, so a table lives as long as the program; equal ones are used again,
// so that a scene that is run a thousand times leaves one
const Table& table_of(std::vector<Row> rows) {
  static std::mutex mutex;
  static std::vector<std::unique_ptr<const Table>> tables;
  const std::scoped_lock lock(mutex);
  for (const auto& table : tables) {
    if (std::equal(rows.begin(), rows.end(), table->rows().begin(), table->rows().end(), same_row)) return *table;
  }
  tables.push_back(std::make_unique<const Table>("scene", "/scene", "", std::move(rows)));
  return *tables.back();
}

}  // namespace

ParamsNode::ParamsNode(Store& store, std::vector<Row> rows)
    : store_(store), id_(store.add(table_of(std::move(rows)), store.root(), "scene", this)) {}

ParamsNode::~ParamsNode() { store_.remove(id_); }

}  // namespace limber
