// C API: types of behaviors_lua/, and queries by the `self` of a behavior written in Lua.
#include <span>

#include <fmt/format.h>

#include "base/text.h"
#include "script/api/script_context.h"
#include "script/behaviors/behavior_scripts.h"
#include "sim/behavior/behavior_group.h"
#include "sim/behavior/behavior_list.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::script::calls {

namespace {

template <class T>
std::int32_t item_result(ScriptContext& c, std::span<T* const> list, std::int32_t index) {
  if (index < 0) return static_cast<std::int32_t>(list.size());
  return c.set_id(list[static_cast<std::size_t>(index)]->id());
}

}  // namespace

std::int32_t behavior_known(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const std::string_view type = text_of(name, length);
  const auto known = context.world->behaviors().types().find(type);
  if (known == nullptr || !known->is_built_in) return context.behaviors->is_loaded(type) ? 1 : 0;
  const std::string file =
      context.answer.top_level != 0 ? context.sources->find_behavior(context.files, type) : std::string();
  if (file.empty()) return 1;
  return context.reject(fmt::format("{}: '{}' is a built-in behavior type; rename the file",
                                    context.files.display_path(file), known->name));
}

std::int32_t behavior_read(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const Result<std::int32_t> file = context.behaviors->read(text_of(name, length));
  if (!file) return context.reject(file.error());
  const BehaviorFile& read = context.behaviors->file(*file);
  context.set_text(fmt::format("{}\n{}\n{}", read.type, read.display_path, read.text));
  return *file;
}

void behavior_forget(void* c, std::int32_t file) { context_of(c).behaviors->remove_last(file); }

std::int32_t behavior_declare(void* c, std::int32_t file, const char* doc, std::int32_t length, std::int32_t is_group) {
  ScriptContext& context = context_of(c);
  constexpr std::size_t kMaxParameters = 64 - sim::kCommonBehaviorProperties;
  if (context.arguments.parameters.size() > kMaxParameters) {
    return context.reject(fmt::format("params: a behavior can have at most {} parameters", kMaxParameters));
  }
  const auto type = context.behaviors->declare(file, printable(text_of(doc, length)), is_group != 0,
                                               std::exchange(context.arguments.parameters, {}));
  if (!type) return context.reject(type.error());
  context.answer.count = static_cast<std::int32_t>(context.world->store().table_number(*(*type)->table));
  return kOk;
}

void in_behavior(void* c, std::int32_t on) { context_of(c).answer.in_behavior = on; }

std::int32_t behavior_item(void* c, std::int32_t slot, std::int32_t generation, std::int32_t kind, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const sim::Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kRemoved;
  if (kind == 1) return item_result(context, behavior->parts(), index);
  if (kind == 2) return item_result(context, behavior->joints(), index);
  return item_result(context, behavior->motors(), index);
}

std::int32_t behavior_body(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const sim::Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kRemoved;
  return context.set_id(behavior->body().id());
}

std::int32_t behavior_due(void* c, std::int32_t slot, std::int32_t generation, std::int32_t property) {
  const ScriptContext& context = context_of(c);
  sim::Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kRemoved;
  return behavior->interval_elapsed(behavior->type().table->property(static_cast<std::uint32_t>(property))) ? 1 : 0;
}

std::int32_t behavior_next(void* c) { return context_of(c).behaviors->next_step(); }

LimberIteration* iterations(void* c) { return context_of(c).neighbors.iterations.data(); }

std::int32_t neighbors(void* c, std::int32_t slot, std::int32_t generation, std::int32_t part_slot,
                       std::int32_t part_generation, double radius, std::int32_t number) {
  ScriptContext& context = context_of(c);
  const sim::Behavior* behavior = behavior_of(context, id_of(slot, generation));
  const sim::Part* part = object_of<sim::Part>(context, id_of(part_slot, part_generation));
  if (behavior == nullptr || part == nullptr) return kRemoved;
  const auto at = static_cast<std::size_t>(number);
  std::vector<sim::Neighbor>& found = context.neighbors.lists[at];
  behavior->group()->neighbors().find_near(*part, radius, found);
  LimberIteration& iteration = context.neighbors.iterations[at];
  iteration = {reinterpret_cast<const LimberNeighbor*>(found.data()), 0, static_cast<std::int32_t>(found.size()),
               iteration.serial + 1};
  context.answer.slot = static_cast<std::int32_t>(behavior->group()->id().slot);
  context.answer.generation = static_cast<std::int32_t>(context.world->store().structure_version());
  return kOk;
}

const LimberGroupMeans* group_means(void* c) { return &context_of(c).neighbors.group_means; }

const LimberMeans* neighbor_means(void* c, std::int32_t slot, std::int32_t generation, std::int32_t part_slot,
                                  std::int32_t part_generation, double min_distance, double max_distance,
                                  std::int32_t want) {
  ScriptContext& context = context_of(c);
  const sim::Behavior* behavior = behavior_of(context, id_of(slot, generation));
  const sim::Part* part = object_of<sim::Part>(context, id_of(part_slot, part_generation));
  if (behavior == nullptr || part == nullptr) return nullptr;
  sim::NeighborSet& set = behavior->group()->neighbors();
  const sim::NeighborMeans& means = set.means_near(*part, min_distance, max_distance, static_cast<unsigned>(want));
  const std::span<const std::int32_t> numbers = set.index_of_slot();
  if (part->id().slot < numbers.size() && numbers[part->id().slot] >= 0) {
    const sim::NeighborMeans* const first = &means - numbers[part->id().slot];
    context.neighbors.group_means = {reinterpret_cast<const LimberMeans*>(first),
                                     numbers.data(),
                                     static_cast<std::int32_t>(numbers.size()),
                                     static_cast<std::int32_t>(behavior->group()->id().slot),
                                     want,
                                     min_distance,
                                     max_distance};
  }
  return reinterpret_cast<const LimberMeans*>(&means);
}

std::int32_t behavior_group(void* c, std::int32_t slot, std::int32_t generation) {
  const sim::Behavior* behavior = behavior_of(context_of(c), id_of(slot, generation));
  return behavior == nullptr ? kRemoved : static_cast<std::int32_t>(behavior->group()->id().slot);
}

std::int32_t neighbor_part(void* c, std::int32_t slot, std::int32_t generation, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const sim::Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kRemoved;
  return item_result(context, behavior->group()->neighbor_parts(), index);
}

}  // namespace limber::script::calls
