// C API: attaching and querying behaviors.
#include <fmt/format.h>

#include "base/text.h"
#include "script/api/script_context.h"
#include "sim/behavior/behavior_list.h"

namespace limber::script::calls {

std::int32_t table_name(void* c, std::int32_t table) {
  ScriptContext& context = context_of(c);
  return context.set_text(context.world->store().tables()[static_cast<std::size_t>(table)]->name());
}

std::int32_t behavior_type(void* c, const char* type, std::int32_t length, std::int32_t group) {
  ScriptContext& context = context_of(c);
  const auto found = context.world->behaviors().types().require(text_of(type, length));
  if (!found) return context.reject(found.error());
  const PropertyTable* const table = group != 0 ? (*found)->group_table : (*found)->table;
  // a type that does not exist in this kind is reported when it is attached
  context.answer.count =
      static_cast<std::int32_t>(context.world->store().table_number(table == nullptr ? *(*found)->table : *table));
  return kOk;
}

void select_clear(void* c) { context_of(c).arguments.selections = {}; }

void select_none(void* c, std::int32_t of) {
  context_of(c).arguments.selections[static_cast<std::size_t>(of)] = sim::Selection(std::vector<std::string>{});
}

void select_word(void* c, std::int32_t of, const char* text, std::int32_t length) {
  sim::Selection& selection = context_of(c).arguments.selections[static_cast<std::size_t>(of)];
  std::vector<std::string> words = selection.words();
  words.emplace_back(text_of(text, length));
  selection = sim::Selection(std::move(words));
}

std::int32_t add_behavior(void* c, std::int32_t slot, std::int32_t generation, const char* type,
                          std::int32_t type_length, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  sim::Body* body = object_of<sim::Body>(context, id_of(slot, generation));
  if (body == nullptr) return kRemoved;
  const auto& selections = context.arguments.selections;
  const Result<sim::Behavior*> behavior =
      context.world->behaviors().add(*body, text_of(type, type_length), std::string(text_of(name, length)),
                                     {selections[0], selections[1], selections[2]});
  return behavior ? context.set_id((*behavior)->id()) : context.reject(behavior.error());
}

std::int32_t add_group(void* c, const char* type, std::int32_t type_length, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const auto& selections = context.arguments.selections;
  const Result<sim::BehaviorGroup*> group = context.world->behaviors().add_group(
      text_of(type, type_length), std::string(text_of(name, length)), {selections[3], selections[0], selections[4]});
  return group ? context.set_id((*group)->id()) : context.reject(group.error());
}

std::int32_t behavior_text(void* c, std::int32_t slot, std::int32_t generation, std::int32_t which) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (const sim::BehaviorGroup* group = group_of(context, id)) return context.set_text(group->type().name);
  const sim::Behavior* const behavior = behavior_of(context, id);
  if (behavior == nullptr) return kRemoved;
  if (which == 0) return context.set_text(behavior->type().name);
  return behavior->error().empty() ? kRejected : context.set_text(behavior->error());
}

}  // namespace limber::script::calls
