// Planning: traversal of the store, and selection of properties by patterns. Caching of plans, and copying of values.
#include "engine/presets/capturer.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <map>
#include <span>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/memory/address_space.h"
#include "base/system/thread.h"
#include "base/system/virtual_memory.h"
#include "base/text.h"
#include "properties/catalog.h"
#include "sim/world/part.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxPlans = 8;
// If at least this fraction (1/8) of the nodes was added or removed, plan at once: the change itself took far longer.
constexpr std::uint64_t kLargeChange = 8;
constexpr int kPatternWork = 8 * PatternBudget::kStepsPerMessage;  // enough for several patterns over a large world
constexpr std::size_t kPrefetchDistance = 3;                       // nodes may be far apart in memory

}  // namespace

// Builds a plan node by node.
class PresetPlanner {
 public:
  PresetPlanner(const Store& store, PresetSelection selection)
      : store_(store), stack_{store.root()}, node_indices_(store.view()->slot_count, 0) {
    if (selection == PresetSelection{}) {
      schema_->reserve(node_indices_.size());
      plan_.nodes.reserve(node_indices_.size());
    }
    plan_.selection = std::move(selection);
  }

  // Adds the settings of up to `count` nodes in the order of the tree; true once all nodes were visited.
  bool advance(std::size_t count);
  // Adds properties of a node, given as a bit mask.
  void add(NodeId id, const PropertyTable& table, std::uint64_t properties);
  PresetPlan finish() {
    plan_.schema = schema_;
    return std::move(plan_);
  }

 private:
  // the settings of a node type
  struct NodeType {
    std::uint64_t settings = 0;
    std::vector<const Property*> conditional;  // read-only on some nodes, such as the mass of a static part
  };
  // the layout of a subset of the properties of a node type, and the ranges that a node contributes
  struct NodeLayout {
    const PropertyTable* table = nullptr;
    std::uint64_t properties = 0;
    std::uint32_t layout = 0;
    std::vector<PresetPlan::CopyRange> ranges;  // relative to the first value of the node
  };
  const NodeType& node_type(const PropertyTable& table);
  const NodeLayout& node_layout(const PropertyTable& table, std::uint64_t properties);
  std::uint64_t settings_of(NodeId id, const PropertyTable& table);
  std::uint32_t node_index(NodeId id);
  static void append(const PresetPlan::CopyRange& range, std::vector<PresetPlan::CopyRange>& ranges);

  const Store& store_;
  PresetPlan plan_;
  std::shared_ptr<PresetSchema> schema_ = std::make_shared<PresetSchema>();
  std::vector<NodeId> stack_;  // nodes to be visited
  std::unordered_map<const PropertyTable*, NodeType> node_types_;
  std::map<std::pair<const PropertyTable*, std::uint64_t>, NodeLayout> node_layouts_;
  // consecutive nodes are usually alike
  std::pair<const PropertyTable*, const NodeType*> last_type_{};
  const NodeLayout* last_layout_ = nullptr;
  std::vector<std::uint32_t> node_indices_;  // by slot: index in the schema; 0: none yet
};

bool PresetPlanner::advance(std::size_t count) {
  while (!stack_.empty()) {
    if (count-- == 0) return false;
    const NodeId id = stack_.back();
    stack_.pop_back();
    if (stack_.size() >= kPrefetchDistance) store_.prefetch_object(stack_[stack_.size() - kPrefetchDistance]);
    const PropertyTable& table = store_.table(id);
    if (const std::uint64_t settings = settings_of(id, table); settings != 0) add(id, table, settings);
    const std::span<const NodeId> children = store_.children(id);
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      store_.prefetch_node(*child);
      stack_.push_back(*child);
    }
  }
  return true;
}

void PresetPlanner::add(NodeId id, const PropertyTable& table, std::uint64_t properties) {
  const NodeLayout& layout = node_layout(table, properties);
  schema_->set_layout(node_index(id), layout.layout);
  const NodeSlot& slot = store_.view()->slots[id.slot];
  for (const PresetPlan::CopyRange& range : layout.ranges)
    append({(range.transient ? slot.transient : slot.persistent) + range.source, range.count, range.transient},
           plan_.ranges);
  plan_.nodes.push_back({id, &table, properties});
}

const PresetPlanner::NodeType& PresetPlanner::node_type(const PropertyTable& table) {
  if (last_type_.first == &table) return *last_type_.second;
  const auto [entry, inserted] = node_types_.try_emplace(&table);
  NodeType& type = entry->second;
  last_type_ = {&table, &type};
  if (!inserted) return type;
  for (const Property& property : table.properties()) {
    if (property.kind != PropertyKind::setting || !property.stored()) continue;
    type.settings |= std::uint64_t{1} << property.index;
    if (property.validate != nullptr) type.conditional.push_back(&property);
  }
  return type;
}

std::uint64_t PresetPlanner::settings_of(NodeId id, const PropertyTable& table) {
  const NodeType& type = node_type(table);
  std::uint64_t settings = type.settings;
  for (const Property* property : type.conditional) {
    if (!property->validate(store_.object(id), store_.values(id, *property)))
      settings &= ~(std::uint64_t{1} << property->index);
  }
  return settings;
}

const PresetPlanner::NodeLayout& PresetPlanner::node_layout(const PropertyTable& table, std::uint64_t properties) {
  if (last_layout_ != nullptr && last_layout_->table == &table && last_layout_->properties == properties)
    return *last_layout_;
  const auto [entry, inserted] = node_layouts_.try_emplace({&table, properties});
  NodeLayout& out = entry->second;
  last_layout_ = &out;
  if (!inserted) return out;
  out.table = &table;
  out.properties = properties;
  PresetLayout layout;
  for (const Property& property : table.properties()) {
    if ((properties >> property.index & 1u) == 0) continue;
    append({property.offset, property.width, property.transient}, out.ranges);
    const bool integer = property.type == PropertyType::integer;
    layout.add({property.name, integer ? PropertyType::number : property.type, property.width, property.choices});
  }
  out.layout = schema_->add_layout(std::move(layout));
  return out;
}

std::uint32_t PresetPlanner::node_index(NodeId id) {
  if (id == store_.root()) return 0;
  std::uint32_t& index = node_indices_[id.slot];
  if (index == 0) index = schema_->add(node_index(store_.parent(id)), store_.name(id));
  return index;
}

void PresetPlanner::append(const PresetPlan::CopyRange& range, std::vector<PresetPlan::CopyRange>& ranges) {
  const bool joins = !ranges.empty() && ranges.back().transient == range.transient &&
                     ranges.back().source + ranges.back().count == range.source;
  if (joins) {
    ranges.back().count += range.count;
  } else {
    ranges.push_back(range);
  }
}

namespace {

// The properties that the patterns of a selection match.
struct MatchedProperties {
  std::vector<std::uint64_t> by_slot;  // bit masks
  bool any_part = false;               // a part is among them

  void add(const Store& store, NodeId id, std::uint64_t properties) {
    by_slot[id.slot] |= properties;
    any_part = any_part || &store.table(id) == &sim::Part::table();
  }
};

Result<MatchedProperties> match_selection(const Store& store, const std::vector<std::string>& patterns) {
  MatchedProperties matched;
  matched.by_slot.assign(store.view()->slot_count, patterns.empty() ? ~std::uint64_t{0} : 0);
  PatternBudget budget{kPatternWork};  // for all patterns together: a message may have thousands
  for (const std::string& pattern : patterns) {
    const Result<std::vector<PropertySet>> found = match_nodes(store, pattern, budget);
    if (!found) return Error{found.error()};
    for (const PropertySet& set : *found) {
      if (set.properties != 0) {
        matched.add(store, set.node, set.properties);
      } else {  // the path of a node selects all properties of the node and its descendants
        store.walk(set.node, [&](NodeId id) { matched.add(store, id, ~std::uint64_t{0}); });
      }
    }
  }
  return matched;
}

// Returns the bits of the state properties of parts (pose, velocity) that the selection includes.
std::uint64_t part_states(const PresetSelection& selection) {
  const auto bit = [](const char* name) { return std::uint64_t{1} << sim::Part::table().at(name).index; };
  return (selection.poses ? bit("position") | bit("rotation") : 0) |
         (selection.velocities ? bit("linear_velocity") | bit("angular_velocity") : 0);
}

// Returns the plan for a selection of the properties in `everything`.
Result<PresetPlan> plan_selection(const Store& store, const PresetPlan& everything, const PresetSelection& selection) {
  const Result<MatchedProperties> matched = match_selection(store, selection.include);
  if (!matched) return Error{matched.error()};
  const std::uint64_t states = part_states(selection);
  PresetPlanner planner(store, selection);
  for (const PresetPlan::Node& node : everything.nodes) {
    const std::uint64_t selected = matched->by_slot[node.id.slot];
    std::uint64_t properties = node.properties & selected;
    // `poses` and `velocities` apply to the parts that the patterns match, or to all if they match none
    if (node.table == &sim::Part::table() && (selected != 0 || !matched->any_part)) properties |= states;
    if (properties != 0) planner.add(node.id, *node.table, properties);
  }
  PresetPlan plan = planner.finish();
  if (plan.nodes.empty() && !selection.include.empty())
    return Error{
        fmt::format("'{}' matches no property", printable(fmt::format("{}", fmt::join(selection.include, " "))))};
  return plan;
}

// Requests large pages, to reduce page faults when a large buffer is first written. A failure is harmless.
void request_large_pages(const std::vector<double>& buffer) {
  constexpr std::size_t kMinBytes = std::size_t{4} << 20u;
  const std::size_t bytes = buffer.capacity() * sizeof(double);
  if (bytes < kMinBytes) return;
  const std::size_t page = system::page_size();
  auto* const first = const_cast<std::byte*>(reinterpret_cast<const std::byte*>(buffer.data()));
  system::prefer_large_pages(align_up(first, page), bytes - page);
}

// Copies the values. `buffer`: memory to reuse if it is large enough.
std::shared_ptr<Preset> copy_values(const Store& store, const PresetPlan& plan, std::string name,
                                    std::vector<double> buffer) {
  buffer.clear();
  auto preset = std::make_shared<Preset>(Preset{std::move(name), plan.selection, plan.schema, std::move(buffer)});
  preset->values.reserve(plan.schema->value_count());
  request_large_pages(preset->values);
  for (const PresetPlan::CopyRange& range : plan.ranges) {
    const double* const from =
        (range.transient ? store.transient_values() : store.persistent_values()).data() + range.source;
    preset->values.insert(preset->values.end(), from, from + range.count);
  }
  return preset;
}

}  // namespace

PresetCapturer::PresetCapturer() = default;
PresetCapturer::~PresetCapturer() = default;

void PresetCapturer::forget_store() {
  everything_.reset();
  selections_.clear();
  planner_.reset();
  settled_calls_ = 0;
}

// Discards outdated plans after a structural change.
void PresetCapturer::discard_outdated(const Store& store) {
  if (structure_version_ == store.structure_version()) return;
  structure_version_ = store.structure_version();
  forget_store();
}

// Allocates and touches a buffer on another thread: the page faults of new memory take longer than copying the values.
void PresetCapturer::allocate_buffer(const Store& store) {
  const std::size_t numbers = store.persistent_values().size();
  if (numbers < kMinBufferValues) return;
  if (next_buffer_.valid()) {
    if (next_buffer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    buffer_ = next_buffer_.get();
  }
  if (buffer_.size() >= numbers) return;
  try {
    next_buffer_ = std::async(std::launch::async, [count = numbers + numbers / 8] {
      system::name_this_thread("limber-buffer");
      std::vector<double> buffer;
      buffer.reserve(count);
      request_large_pages(buffer);
      buffer.resize(count);
      return buffer;
    });
  } catch (const std::system_error&) {
    // no thread available: the next capture takes longer
  }
}

void PresetCapturer::prepare(const Store& store) {
  const std::uint64_t changes = store.structure_version() - structure_version_;
  discard_outdated(store);
  allocate_buffer(store);
  if (changes * kLargeChange >= store.view()->slot_count) return finish_planning(store);
  if (settled_calls_ <= kSettleCalls) settled_calls_++;
  if (settled_calls_ <= kSettleCalls || everything_) return;
  advance_plan(store, kNodesPerCall);
}

void PresetCapturer::advance_plan(const Store& store, std::size_t nodes) {
  if (planner_ == nullptr) planner_ = std::make_unique<PresetPlanner>(store, PresetSelection{});
  if (!planner_->advance(nodes)) return;
  everything_ = planner_->finish();
  planner_.reset();
}

const PresetPlan& PresetCapturer::plan_everything(const Store& store) {
  discard_outdated(store);
  if (!everything_) advance_plan(store, SIZE_MAX);
  return *everything_;
}

// Returns the plan for a selection; valid until the next call.
Result<const PresetPlan*> PresetCapturer::plan_for(const Store& store, const PresetSelection& selection) {
  const PresetPlan& all = plan_everything(store);
  if (selection == PresetSelection{}) return &all;
  const auto cached = std::ranges::find(selections_, selection, &PresetPlan::selection);
  if (cached != selections_.end()) return &*cached;
  Result<PresetPlan> plan = plan_selection(store, all, selection);
  if (!plan) return Error{plan.error()};
  if (selections_.size() >= kMaxPlans) selections_.erase(selections_.begin());
  return &selections_.emplace_back(std::move(*plan));
}

Result<std::shared_ptr<const Preset>> PresetCapturer::capture(const Store& store, std::string name,
                                                              const PresetSelection& selection) {
  const Result<const PresetPlan*> plan = plan_for(store, selection);
  if (!plan) return Error{plan.error()};
  // a much smaller preset must not waste the buffer
  std::vector<double> buffer;
  if ((*plan)->schema->value_count() > buffer_.size() / 2) buffer.swap(buffer_);
  return std::shared_ptr<const Preset>(copy_values(store, **plan, std::move(name), std::move(buffer)));
}

std::shared_ptr<const Preset> PresetCapturer::capture_script(const Store& store) {
  PresetPlanner planner(store, {});
  (void)planner.advance(SIZE_MAX);
  const PresetPlan plan = planner.finish();
  const std::shared_ptr<Preset> preset = copy_values(store, plan, "script", {});
  const NodeId scene = store.child(store.root(), "scene");
  std::size_t at = 0;
  for (const PresetPlan::Node& node : plan.nodes) {
    for (std::uint64_t left = node.properties; left != 0; left &= left - 1) {
      const Property& property = node.table->property(static_cast<std::uint32_t>(std::countr_zero(left)));
      if (node.id == scene) std::copy_n(property.initial.begin(), property.width, preset->values.data() + at);
      at += property.width;
    }
  }
  return preset;
}

}  // namespace limber::engine
