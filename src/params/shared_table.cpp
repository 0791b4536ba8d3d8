// Tables that come while the program runs, kept for its life.
#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "params/table.h"

namespace limber {

namespace {

bool same_row(const Row& a, const Row& b) {
  return a.name == b.name && a.type == b.type && a.kind == b.kind && a.unit == b.unit && a.min == b.min &&
         a.max == b.max && a.axis_min == b.axis_min && a.axis_max == b.axis_max && a.step == b.step &&
         a.initial == b.initial && a.doc == b.doc && a.choices == b.choices && a.own_axis == b.own_axis &&
         a.turns == b.turns && a.live == b.live && a.effect == b.effect && a.read == b.read && a.write == b.write &&
         a.say == b.say && a.refuse == b.refuse && a.act == b.act && a.written == b.written &&
         a.min_args == b.min_args && a.max_args == b.max_args;
}

}  // namespace

const Table& shared_table(std::string name, std::string path, std::vector<Row> rows) {
  static std::mutex mutex;
  static auto& tables = *new std::vector<std::unique_ptr<const Table>>;  // a store may go after whatever else is static
  const std::scoped_lock lock(mutex);
  for (const auto& table : tables) {
    if (table->name() != name || table->path() != path) continue;
    if (std::equal(rows.begin(), rows.end(), table->rows().begin(), table->rows().end(), same_row)) return *table;
  }
  tables.push_back(std::make_unique<const Table>(std::move(name), std::move(path), "", std::move(rows)));
  return *tables.back();
}

}  // namespace limber
