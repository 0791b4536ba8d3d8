// Behind the door: types of behaviors_lua/, and what the `self` of a behaviour written in Lua asks.
#include <span>

#include <fmt/format.h>

#include "base/text.h"
#include "script/behavior_scripts.h"
#include "script/context.h"
#include "sim/behavior_group.h"
#include "sim/behavior_list.h"

namespace limber::calls {

namespace {

template <class T>
std::int32_t told(ScriptContext& c, std::span<T* const> list, std::int32_t index) {
  if (index < 0) return static_cast<std::int32_t>(list.size());
  return c.tell(list[static_cast<std::size_t>(index)]->id());
}

}  // namespace

std::int32_t behavior_known(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const std::string_view type = text_of(name, length);
  const auto known = context.world->behaviors().types().find(type);
  if (known == nullptr || !known->is_built_in) return context.behaviors->knows(type) ? 1 : 0;
  const std::string file =
      context.answer.top_level != 0 ? context.sources->find_behavior(context.files, type) : std::string();
  if (file.empty()) return 1;
  return context.refuse(fmt::format("{}: '{}' is a built-in behavior type; call the file something else",
                                    context.files.shown(file), known->name));
}

std::int32_t behavior_read(void* c, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const Result<std::int32_t> file = context.behaviors->read(text_of(name, length));
  if (!file) return context.refuse(file.error());
  const BehaviorFile& read = context.behaviors->file(*file);
  context.say(fmt::format("{}\n{}\n{}", read.type, read.shown, read.text));
  return *file;
}

void behavior_forget(void* c, std::int32_t file) { context_of(c).behaviors->forget(file); }

std::int32_t behavior_declare(void* c, std::int32_t file, const char* doc, std::int32_t length, std::int32_t is_group) {
  ScriptContext& context = context_of(c);
  constexpr std::size_t kMost = 64 - kCommonBehaviorRows;
  if (context.param_rows.size() > kMost) {
    return context.refuse(fmt::format("params: a behavior may have {} parameters", kMost));
  }
  const auto type = context.behaviors->declare(file, printable(text_of(doc, length)), is_group != 0,
                                               std::exchange(context.param_rows, {}));
  if (!type) return context.refuse(type.error());
  context.answer.count = static_cast<std::int32_t>(context.world->store().table_number(*(*type)->table));
  return kOk;
}

void in_behavior(void* c, std::int32_t on) { context_of(c).answer.in_behavior = on; }

std::int32_t behavior_item(void* c, std::int32_t slot, std::int32_t generation, std::int32_t kind, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kGone;
  if (kind == 1) return told(context, behavior->parts(), index);
  if (kind == 2) return told(context, behavior->joints(), index);
  return told(context, behavior->motors(), index);
}

std::int32_t behavior_body(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kGone;
  return context.tell(behavior->body().id());
}

std::int32_t behavior_due(void* c, std::int32_t slot, std::int32_t generation, std::int32_t row) {
  const ScriptContext& context = context_of(c);
  Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kGone;
  return behavior->due(behavior->type().table->row(static_cast<std::uint32_t>(row))) ? 1 : 0;
}

std::int32_t behavior_next(void* c) { return context_of(c).behaviors->next_step(); }

LimberWalk* walks(void* c) { return context_of(c).walks.data(); }

std::int32_t neighbors(void* c, std::int32_t slot, std::int32_t generation, std::int32_t part_slot,
                       std::int32_t part_generation, double radius, std::int32_t number) {
  ScriptContext& context = context_of(c);
  const Behavior* behavior = behavior_of(context, id_of(slot, generation));
  const Part* part = thing_of<Part>(context, id_of(part_slot, part_generation));
  if (behavior == nullptr || part == nullptr) return kGone;
  const auto at = static_cast<std::size_t>(number);
  std::vector<Neighbor>& found = context.found[at];
  behavior->group()->neighbors().near(*part, radius, found);
  LimberWalk& walk = context.walks[at];
  walk = {reinterpret_cast<const LimberNeighbor*>(found.data()), 0, static_cast<std::int32_t>(found.size()),
          walk.serial + 1};
  context.answer.slot = static_cast<std::int32_t>(behavior->group()->id().slot);
  context.answer.generation = static_cast<std::int32_t>(context.world->store().structure_version());
  return kOk;
}

const LimberMeansOfAll* means_of_all(void* c) { return &context_of(c).means_of_all; }

const LimberMeans* neighbor_means(void* c, std::int32_t slot, std::int32_t generation, std::int32_t part_slot,
                                  std::int32_t part_generation, double least, double most, std::int32_t want) {
  ScriptContext& context = context_of(c);
  const Behavior* behavior = behavior_of(context, id_of(slot, generation));
  const Part* part = thing_of<Part>(context, id_of(part_slot, part_generation));
  if (behavior == nullptr || part == nullptr) return nullptr;
  NeighborSet& set = behavior->group()->neighbors();
  const NeighborMeans& means = set.means_near(*part, least, most, static_cast<unsigned>(want));
  const std::span<const std::int32_t> numbers = set.numbers();
  if (part->id().slot < numbers.size() && numbers[part->id().slot] >= 0) {
    const NeighborMeans* const first = &means - numbers[part->id().slot];
    context.means_of_all = {reinterpret_cast<const LimberMeans*>(first),
                            numbers.data(),
                            static_cast<std::int32_t>(numbers.size()),
                            static_cast<std::int32_t>(behavior->group()->id().slot),
                            want,
                            least,
                            most};
  }
  return reinterpret_cast<const LimberMeans*>(&means);
}

std::int32_t behavior_group(void* c, std::int32_t slot, std::int32_t generation) {
  const Behavior* behavior = behavior_of(context_of(c), id_of(slot, generation));
  return behavior == nullptr ? kGone : static_cast<std::int32_t>(behavior->group()->id().slot);
}

std::int32_t neighbor_part(void* c, std::int32_t slot, std::int32_t generation, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const Behavior* behavior = behavior_of(context, id_of(slot, generation));
  if (behavior == nullptr) return kGone;
  return told(context, behavior->group()->neighbor_parts(), index);
}

}  // namespace limber::calls
