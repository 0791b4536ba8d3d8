// Behind the door: attaching behaviours, what they are.
#include <fmt/format.h>

#include "base/text.h"
#include "script/context.h"

namespace limber::calls {

std::int32_t table_name(void* c, std::int32_t table) {
  ScriptContext& context = context_of(c);
  return context.say(context.world->store().tables()[static_cast<std::size_t>(table)]->name());
}

std::int32_t behavior_type(void* c, const char* type, std::int32_t length, std::int32_t group) {
  ScriptContext& context = context_of(c);
  const auto found = context.world->behaviors().types().require(text_of(type, length));
  if (!found) return context.refuse(found.error());
  const Table* const table = group != 0 ? (*found)->group_table : (*found)->table;
  // what is wrong with the other kind is said when it is attached
  context.answer.count =
      static_cast<std::int32_t>(context.world->store().table_number(table == nullptr ? *(*found)->table : *table));
  return kOk;
}

void select_clear(void* c) { context_of(c).selections = {}; }

void select_none(void* c, std::int32_t of) {
  context_of(c).selections[static_cast<std::size_t>(of)] = Selection(std::vector<std::string>{});
}

void select_word(void* c, std::int32_t of, const char* text, std::int32_t length) {
  Selection& selection = context_of(c).selections[static_cast<std::size_t>(of)];
  std::vector<std::string> words = selection.words();
  words.emplace_back(text_of(text, length));
  selection = Selection(std::move(words));
}

std::int32_t add_behavior(void* c, std::int32_t slot, std::int32_t generation, const char* type,
                          std::int32_t type_length, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  Body* body = thing_of<Body>(context, id_of(slot, generation));
  if (body == nullptr) return kGone;
  const auto& said = context.selections;
  const Result<Behavior*> behavior = context.world->behaviors().add(
      *body, text_of(type, type_length), std::string(text_of(name, length)), {said[0], said[1], said[2]});
  return behavior ? context.tell((*behavior)->id()) : context.refuse(behavior.error());
}

std::int32_t add_group(void* c, const char* type, std::int32_t type_length, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const auto& said = context.selections;
  const Result<BehaviorGroup*> group = context.world->behaviors().add_group(
      text_of(type, type_length), std::string(text_of(name, length)), {said[3], said[0], said[4]});
  return group ? context.tell((*group)->id()) : context.refuse(group.error());
}

std::int32_t behavior_text(void* c, std::int32_t slot, std::int32_t generation, std::int32_t which) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (const BehaviorGroup* group = group_of(context, id)) return context.say(group->type().name);
  const Behavior* const behavior = behavior_of(context, id);
  if (behavior == nullptr) return kGone;
  if (which == 0) return context.say(behavior->type().name);
  return behavior->error().empty() ? kRefused : context.say(behavior->error());
}

}  // namespace limber::calls
