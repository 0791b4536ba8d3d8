// Caching of plans, and copying of values.
#include "engine/presets/capturer.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "base/memory/address_space.h"
#include "base/system/thread.h"
#include "base/system/virtual_memory.h"
#include "properties/catalog.h"

namespace limber {

namespace {

constexpr std::size_t kMaxPlans = 8;
// If at least this fraction (1/8) of the nodes was added or removed, plan at once: the change itself took far longer.
constexpr std::uint64_t kLargeChange = 8;

// Requests large pages, to reduce page faults when a large buffer is first written. A failure is harmless.
void request_large_pages(const std::vector<double>& buffer) {
  constexpr std::size_t kMinBytes = std::size_t{4} << 20u;
  const std::size_t bytes = buffer.capacity() * sizeof(double);
  if (bytes < kMinBytes) return;
  const std::size_t page = system::page_size();
  auto* const first = const_cast<std::byte*>(reinterpret_cast<const std::byte*>(buffer.data()));
  system::prefer_large_pages(align_up(first, page), bytes - page);
}

}  // namespace

PresetCapturer::PresetCapturer() = default;
PresetCapturer::~PresetCapturer() = default;

void PresetCapturer::forget_store() {
  everything_.reset();
  selections_.clear();
  previous_.reset();
  planner_.reset();
  settled_calls_ = 0;
}

// Discards outdated plans after a structural change; keeps the one for all properties as a base for the next.
void PresetCapturer::discard_outdated(const Store& store) {
  if (structure_version_ == store.structure_version()) return;
  structure_version_ = store.structure_version();
  planner_.reset();
  settled_calls_ = 0;
  if (everything_) previous_ = std::move(everything_);
  everything_.reset();
  selections_.clear();
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
  if (planner_ == nullptr) planner_ = std::make_unique<PresetPlanner>(store, previous_ ? &*previous_ : nullptr);
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
  Result<PresetPlan> plan = PresetPlan::for_selection(store, all, selection);
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
  return copy(store, **plan, std::move(name), std::move(buffer));
}

std::shared_ptr<const Preset> PresetCapturer::copy(const Store& store, const PresetPlan& plan, std::string name,
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

std::shared_ptr<const Preset> PresetCapturer::capture_script(const Store& store) {
  auto preset = std::make_shared<Preset>(*copy(store, PresetPlanner::make(store, nullptr), "script", {}));
  const Result<PropertyRef> scene = find_property(store, "/scene", false);
  if (!scene || scene->property != nullptr) return preset;
  const PropertyTable& table = store.table(scene->node);
  for (const PresetSchema::Node& node : preset->schema->nodes()) {
    const PresetLayout* const layout = preset->schema->layout(node);
    if (layout == nullptr || node.parent != 0 || preset->schema->name(node) != "scene") continue;
    for (std::size_t i = 0; i < layout->properties.size(); i++) {
      const Property& property = table.at(layout->properties[i].name);
      std::copy_n(property.initial.begin(), property.width, preset->values.begin() + node.offset + layout->offsets[i]);
    }
  }
  return preset;
}

}  // namespace limber
