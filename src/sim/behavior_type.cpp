// The types' tables, the list of the built-in ones, a world's registry.
#include "sim/behavior_type.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "base/text.h"
#include "sim/behavior.h"
#include "sim/behavior_group.h"

namespace limber {

namespace {

using namespace rows;
using Describe = BehaviorType (*)();

std::vector<Describe>& registered() {
  static std::vector<Describe> list;
  return list;
}

std::vector<Row> with_common(std::vector<Row> common, const std::vector<Row>& parameters) {
  LIMBER_CHECK(common.size() == kCommonBehaviorRows);
  for (const Row& row : parameters) {
    LIMBER_CHECK(row.kind == RowKind::property && row.effect == nullptr && !row.view() && !row.live);
    common.push_back(row);
  }
  return common;
}

Row error_row() {
  Row row = text("error", "Why it rests although it is active; empty: it does not.");
  row.say = [](const void* thing) -> std::string_view { return static_cast<const Behavior*>(thing)->error(); };
  return row;
}

}  // namespace

std::string plain_type_name(std::string_view name) {
  constexpr std::string_view kEnd = "behavior";
  std::string plain = plain_name(name);
  if (plain.size() > kEnd.size() && plain.ends_with(kEnd)) plain.resize(plain.size() - kEnd.size());
  return plain;
}

BehaviorType BehaviorType::of(std::string name, std::string doc, BehaviorTargets targets, bool is_group,
                              std::vector<Row> parameters, std::function<std::unique_ptr<Behavior>()> make) {
  BehaviorType type;
  std::vector<Row> rows = with_common(Behavior::common_rows(), parameters);
  rows.push_back(error_row());  // last: it has no number, and so no place in a scene's said rows
  type.table = &shared_table("behavior", fmt::format("/physics/body/<body>/behavior/<{}>", name), std::move(rows));
  if (is_group) {
    for (Row& row : parameters) row.written = &BehaviorGroup::hand_on;
    type.group_table = &shared_table("group", fmt::format("/physics/group/<{}>", name),
                                     with_common(BehaviorGroup::common_rows(), parameters));
  }
  type.name = std::move(name);
  type.doc = std::move(doc);
  type.targets = targets;
  type.is_group = is_group;
  type.make = std::move(make);
  return type;
}

BuiltInBehavior::BuiltInBehavior(Describe describe) { registered().push_back(describe); }

BehaviorTypes::BehaviorTypes() {
  for (const Describe describe : registered()) {
    BehaviorType type = describe();
    type.is_built_in = true;
    types_.push_back(std::make_shared<const BehaviorType>(std::move(type)));
  }
  std::sort(types_.begin(), types_.end(), [](const auto& a, const auto& b) { return a->name < b->name; });
}

Result<void> BehaviorTypes::add(BehaviorType type) {
  if (const auto fault = name_fault(type.name)) return Error{fmt::format("behavior type: {}", *fault)};
  const std::string plain = plain_type_name(type.name);
  const auto same = [&](const auto& t) { return plain_type_name(t->name) == plain; };
  const auto known = std::find_if(types_.begin(), types_.end(), same);
  if (known != types_.end() && (*known)->is_built_in) {
    return Error{fmt::format("'{}' is a built-in behavior type ('{}'); call the file something else",
                             printable(type.name), (*known)->name)};
  }
  auto shared = std::make_shared<const BehaviorType>(std::move(type));
  if (known != types_.end()) {
    *known = std::move(shared);
  } else {
    types_.push_back(std::move(shared));
  }
  return {};
}

void BehaviorTypes::remove(std::string_view name) {
  const std::string plain = plain_type_name(name);
  std::erase_if(types_, [&](const auto& t) { return !t->is_built_in && plain_type_name(t->name) == plain; });
}

std::shared_ptr<const BehaviorType> BehaviorTypes::find(std::string_view name) const {
  const std::string plain = plain_type_name(name);
  for (const auto& type : types_) {
    if (plain_type_name(type->name) == plain) return type;
  }
  return nullptr;
}

Result<std::shared_ptr<const BehaviorType>> BehaviorTypes::require(std::string_view name) const {
  if (std::shared_ptr<const BehaviorType> type = find(name)) return type;
  std::vector<std::string_view> names;
  for (const auto& type : types_) names.push_back(type->name);
  // near ones are looked for without the ending of the seed's class names
  const std::string plain = plain_type_name(name);
  const std::string_view written = plain.size() < plain_name(name).size() ? plain : name;
  return Error{fmt::format("there is no behavior type '{}'{}", printable(name), name_hint(written, names))};
}

}  // namespace limber
