// Traversal of the store, and the selection of properties from its result.
#include "engine/presets/planner.h"

#include <algorithm>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"
#include "properties/catalog.h"
#include "properties/path_matcher.h"
#include "sim/world/part.h"

namespace limber {

namespace {

constexpr int kPatternWork = 8 * PatternBudget::kStepsPerMessage;  // enough for several patterns over a large world
constexpr std::size_t kPrefetchDistance = 3;  // prefetch distance: nodes may be far apart in memory

PresetProperty preset_property(const Property& property) {
  const PropertyType type = property.type == PropertyType::integer ? PropertyType::number : property.type;
  return {property.name, type, property.width, property.choices};
}

// Returns the bits of the state properties of parts (pose, velocity) that the selection includes.
std::uint64_t part_states(const PresetSelection& selection) {
  std::uint64_t properties = 0;
  const auto add = [&](const char* name) { properties |= std::uint64_t{1} << Part::table().at(name).index; };
  if (selection.poses) {
    add("position");
    add("rotation");
  }
  if (selection.velocities) {
    add("linear_velocity");
    add("angular_velocity");
  }
  return properties;
}

}  // namespace

void PresetPlan::append(const CopyRange& range, std::vector<CopyRange>& ranges) {
  const bool joins = !ranges.empty() && ranges.back().transient == range.transient &&
                     ranges.back().source + ranges.back().count == range.source;
  if (joins) {
    ranges.back().count += range.count;
  } else {
    ranges.push_back(range);
  }
}

const PresetPlan::NodePlan& PresetPlan::node_plan(PresetSchema& schema, const PropertyTable& table,
                                                  std::uint64_t properties) {
  if (last_node_plan_ != nullptr && last_node_plan_->table == &table && last_node_plan_->properties == properties)
    return *last_node_plan_;
  const auto [entry, inserted] = node_plans_.try_emplace({&table, properties});
  NodePlan& node_plan = entry->second;
  last_node_plan_ = &node_plan;
  if (!inserted) return node_plan;
  node_plan.table = &table;
  node_plan.properties = properties;
  auto layout = std::make_shared<PresetLayout>();
  for (const Property& property : table.properties()) {
    if ((properties >> property.index & 1u) == 0) continue;
    append({property.offset, property.width, property.transient, layout->value_count}, node_plan.ranges);
    layout->add(preset_property(property));
  }
  node_plan.layout = schema.add_layout(std::move(layout));
  return node_plan;
}

// Adds the ranges of a node; its values start at `at` in the preset.
void PresetPlan::append_node(const NodePlan& node_plan, const NodeSlot& slot, std::uint32_t at) {
  for (const CopyRange& range : node_plan.ranges)
    append({(range.transient ? slot.transient : slot.persistent) + range.source, range.count, range.transient,
            at + range.destination});
}

PresetPlanner::PresetPlanner(const Store& store, const PresetPlan* previous) : store_(store), previous_(previous) {
  plan_.structure_version_ = store.structure_version();
  node_indices_.assign(store_.view()->slot_count, 0);
  schema_->reserve(node_indices_.size());
  plan_.node_ids_.reserve(node_indices_.size());
  plan_.node_ids_.push_back(store_.root());
  stack_.push_back(store_.root());
  if (previous_ == nullptr) return;
  previous_indices_.assign(node_indices_.size(), 0);
  for (std::uint32_t i = 0; i < previous_->node_ids_.size(); i++) previous_indices_[previous_->node_ids_[i].slot] = i;
  for (const auto& layout : previous_->schema->layouts()) schema_->add_layout(layout);
  plan_.node_plans_ = previous_->node_plans_;
  plan_.ranges.reserve(previous_->ranges.size() + previous_->ranges.size() / 8);
}

bool PresetPlanner::advance(std::size_t count) {
  while (!stack_.empty()) {
    if (count-- == 0) return false;
    const NodeId id = stack_.back();
    stack_.pop_back();
    if (stack_.size() >= kPrefetchDistance) store_.prefetch_object(stack_[stack_.size() - kPrefetchDistance]);
    if (previous_ != nullptr && id != store_.root() && store_.changed_version(id) <= previous_->structure_version_) {
      copy_unchanged(id);
      continue;
    }
    add(id);
    const std::span<const NodeId> children = store_.children(id);
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      store_.prefetch_node(*child);
      stack_.push_back(*child);
    }
  }
  return true;
}

PresetPlan PresetPlanner::finish() {
  plan_.schema = schema_;
  plan_.last_node_plan_ = nullptr;  // it points into this plan, and would dangle in a copy
  return std::move(plan_);
}

PresetPlan PresetPlanner::make(const Store& store, const PresetPlan* previous) {
  PresetPlanner planner(store, previous);
  (void)planner.advance(SIZE_MAX);
  return planner.finish();
}

const PresetPlanner::NodeType& PresetPlanner::node_type(const PropertyTable& table) {
  if (last_node_type_.first == &table) return *last_node_type_.second;
  const auto [entry, inserted] = node_types_.try_emplace(&table);
  NodeType& type = entry->second;
  last_node_type_ = {&table, &type};
  if (!inserted) return type;
  for (const Property& property : table.properties()) {
    if (property.kind != PropertyKind::setting || !property.stored()) continue;
    type.properties |= std::uint64_t{1} << property.index;
    if (property.validate != nullptr) type.conditional.push_back(&property);
  }
  return type;
}

void PresetPlanner::add(NodeId id) {
  const PropertyTable& table = store_.table(id);
  const NodeType& type = node_type(table);
  std::uint64_t properties = type.properties;
  for (const Property* property : type.conditional) {
    if (!property->validate(store_.object(id), store_.values(id, *property)))
      properties &= ~(std::uint64_t{1} << property->index);
  }
  if (properties == 0) return;
  const PresetPlan::NodePlan& node_plan = plan_.node_plan(*schema_, table, properties);
  const std::uint32_t at = schema_->value_count();
  schema_->set_layout(node_index(id), node_plan.layout);
  plan_.append_node(node_plan, store_.view()->slots[id.slot], at);
}

// Copies an unchanged node and its descendants from the older plan.
void PresetPlanner::copy_unchanged(NodeId id) {
  const std::uint32_t first = previous_indices_[id.slot];
  if (first == 0) return;  // no property there
  const std::uint32_t begin = schema_->value_count();
  const std::uint32_t first_copy = schema_->copy_subtree(*previous_->schema, first, node_index(store_.parent(id)));
  const auto from = previous_->node_ids_.begin() + first;
  plan_.node_ids_.insert(plan_.node_ids_.end(), from,
                         from + static_cast<std::ptrdiff_t>(schema_->nodes().size() - first_copy));
  copy_ranges(previous_->schema->first_value(first), begin, schema_->value_count() - begin);
}

// Copies `count` values' ranges, from offset `from` in the old preset to `to` in the new one.
void PresetPlanner::copy_ranges(std::uint32_t from, std::uint32_t to, std::uint32_t count) {
  const std::vector<PresetPlan::CopyRange>& ranges = previous_->ranges;
  auto at = std::upper_bound(
      ranges.begin(), ranges.end(), from,
      [](std::uint32_t number, const PresetPlan::CopyRange& range) { return number < range.destination; });
  if (count > 0) --at;
  for (std::uint32_t done = 0; done < count; ++at) {
    const std::uint32_t skipped = from + done - at->destination;
    const std::uint32_t copied = std::min(at->count - skipped, count - done);
    const PresetPlan::CopyRange range{at->source + skipped, copied, at->transient, to + done};
    // only the first range can be adjacent to the previous one
    if (done == 0) {
      plan_.append(range);
    } else {
      plan_.ranges.push_back(range);
    }
    done += copied;
  }
}

std::uint32_t PresetPlanner::node_index(NodeId id) {
  if (id == store_.root()) return 0;
  std::uint32_t& index = node_indices_[id.slot];
  if (index == 0) {
    const std::uint32_t parent = node_index(store_.parent(id));
    index = schema_->add(parent, store_.name(id));
    plan_.node_ids_.push_back(id);
  }
  return index;
}

// View of the nodes of a plan for pattern matching with PathMatcher: compact, and without nodes that have no property.
// Nodes are identified by their index.
class PresetPlan::NodeView {
 public:
  struct Ref {
    std::uint32_t node = 0;
    const Property* property = nullptr;
  };
  struct Set {
    std::uint32_t node = 0;
    std::uint64_t properties = 0;
  };

  NodeView(const Store& store, const PresetPlan& plan) : store_(store), plan_(plan), end_(size()) {
    // descendants directly follow their node
    for (auto i = static_cast<std::uint32_t>(size()); i-- > 0;) {
      end_[i] = std::max(end_[i], i + 1);
      std::uint32_t& parents = end_[all()[i].parent];
      parents = std::max(parents, end_[i]);
    }
    plan_of_layout_.resize(plan.schema->layouts().size());
    for (const auto& [key, node_plan] : plan.node_plans_) plan_of_layout_[node_plan.layout] = &node_plan;
  }

  std::size_t size() const { return all().size(); }
  /// Index after the last descendant of a node.
  std::uint32_t end(std::uint32_t node) const { return end_[node]; }
  /// The properties of a node, or null.
  const NodePlan* node_plan(std::uint32_t node) const {
    return all()[node].layout == PresetSchema::kNoLayout ? nullptr : plan_of_layout_[all()[node].layout];
  }
  /// Returns the index of a node of the store, or size().
  std::uint32_t find(NodeId node) {
    if (node_of_slot_.empty()) {
      node_of_slot_.assign(store_.view()->slot_count, static_cast<std::uint32_t>(size()));
      for (std::uint32_t i = 0; i < size(); i++) node_of_slot_[plan_.node_ids_[i].slot] = i;
    }
    return node_of_slot_[node.slot];
  }

  // interface for PathMatcher
  std::uint32_t root() const { return 0; }
  std::string_view name(std::uint32_t node) const { return plan_.schema->name(all()[node]); }
  const PropertyTable& table(std::uint32_t node) const {
    const NodePlan* const plan = node_plan(node);
    return plan != nullptr ? *plan->table : store_.table(plan_.node_ids_[node]);
  }
  std::string path(std::uint32_t node) const { return plan_.schema->path(node); }
  std::uint32_t key(std::uint32_t node) const { return node; }
  std::size_t keys() const { return size(); }
  std::optional<std::uint32_t> exact_child(std::uint32_t parent, std::string_view wanted) const {
    std::optional<std::uint32_t> found;
    each_child(parent, [&](std::uint32_t child) {
      if (name(child) == wanted) found = child;
      return !found;
    });
    return found;
  }
  template <class F>
  void each_child(std::uint32_t parent, F&& f) const {
    for (std::uint32_t child = parent + 1; child < end_[parent]; child = end_[child]) {
      if (!f(child)) return;
    }
  }

 private:
  const std::vector<PresetSchema::Node>& all() const { return plan_.schema->nodes(); }

  const Store& store_;
  const PresetPlan& plan_;
  std::vector<std::uint32_t> end_;
  std::vector<const NodePlan*> plan_of_layout_;
  std::vector<std::uint32_t> node_of_slot_;  // filled by the first find()
};

class PresetPlan::Selector {
 public:
  Selector(const Store& store, const PresetPlan& everything, const PresetSelection& selection)
      : store_(store),
        everything_(everything),
        nodes_(store, everything),
        part_states_(part_states(selection)),
        selected_(nodes_.size(), selection.include.empty() ? ~std::uint64_t{0} : 0) {
    plan_.selection = selection;
  }

  Result<PresetPlan> make() {
    for (const std::string& pattern : plan_.selection.include) {
      if (const Result<void> chosen = select(pattern); !chosen) return Error{chosen.error()};
    }
    const auto count =
        static_cast<std::size_t>(std::ranges::count_if(selected_, [](auto properties) { return properties != 0; }));
    schema_->reserve(count + count / 4);  // with an allowance for their ancestors
    plan_.node_ids_.reserve(count + count / 4);
    plan_.ranges.reserve(2 * count);
    plan_.node_ids_.push_back(store_.root());
    new_nodes_.assign(nodes_.size(), 0);
    for (std::uint32_t i = 0; i < nodes_.size(); i++) add(i);
    const std::vector<std::string>& patterns = plan_.selection.include;
    if (!patterns.empty() && schema_->property_count() == 0)
      return Error{fmt::format("'{}' matches no property", printable(fmt::format("{}", fmt::join(patterns, " "))))};
    plan_.schema = schema_;
    plan_.last_node_plan_ = nullptr;
    return std::move(plan_);
  }

 private:
  Result<void> select(const std::string& pattern) {
    if (is_address_pattern(pattern)) {
      const auto found = PathMatcher(nodes_, budget_).match_nodes(pattern, SIZE_MAX);
      if (!found) return Error{found.error()};
      for (const NodeView::Set& ref : *found) select(ref.node, ref.properties);
      return {};
    }
    const Result<PropertyRef> ref = find_property(store_, pattern);
    if (!ref) return Error{ref.error()};
    const std::uint32_t node = nodes_.find(ref->node);
    if (node == nodes_.size()) return {};
    if (ref->property != nullptr) {
      select(node, std::uint64_t{1} << ref->property->index);
    } else {
      // the path of a node selects all properties of the node and its descendants
      for (std::uint32_t i = node; i < nodes_.end(node); i++) select(i, ~std::uint64_t{0});
    }
    return {};
  }

  void select(std::uint32_t node, std::uint64_t properties) {
    selected_[node] |= properties;
    part_selected_ = part_selected_ || &nodes_.table(node) == &Part::table();
  }

  void add(std::uint32_t node) {
    const NodePlan* const full_plan = nodes_.node_plan(node);
    if (full_plan == nullptr) return;
    std::uint64_t properties = full_plan->properties & selected_[node];
    // `poses` and `velocities` apply to the parts that the patterns match, or to all if they match none
    if (part_states_ != 0 && full_plan->table == &Part::table() && (selected_[node] != 0 || !part_selected_))
      properties |= part_states_;
    if (properties == 0) return;
    const NodePlan& node_plan = plan_.node_plan(*schema_, *full_plan->table, properties);
    const std::uint32_t at = schema_->value_count();
    schema_->set_layout(new_node(node), node_plan.layout);
    plan_.append_node(node_plan, store_.view()->slots[everything_.node_ids_[node].slot], at);
  }

  std::uint32_t new_node(std::uint32_t node) {
    if (node == 0) return 0;
    if (new_nodes_[node] == 0) {
      const PresetSchema::Node& source = everything_.schema->nodes()[node];
      const std::uint32_t parent = new_node(source.parent);
      new_nodes_[node] = schema_->add(parent, everything_.schema->name(source));
      plan_.node_ids_.push_back(everything_.node_ids_[node]);
    }
    return new_nodes_[node];
  }

  const Store& store_;
  const PresetPlan& everything_;
  NodeView nodes_;
  std::uint64_t part_states_;
  PatternBudget budget_{kPatternWork};   // for all patterns together: a message may have thousands
  std::vector<std::uint64_t> selected_;  // bits of the selected properties, by node
  bool part_selected_ = false;
  PresetPlan plan_;
  std::shared_ptr<PresetSchema> schema_ = std::make_shared<PresetSchema>();
  std::vector<std::uint32_t> new_nodes_;  // indices of the nodes in the new schema
};

Result<PresetPlan> PresetPlan::for_selection(const Store& store, const PresetPlan& everything,
                                             const PresetSelection& selection) {
  return Selector(store, everything, selection).make();
}

}  // namespace limber
