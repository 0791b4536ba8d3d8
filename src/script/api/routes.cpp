// C API: routes.
#include <string>

#include "base/text.h"
#include "script/api/script_context.h"
#include "sim/behavior/behavior_list.h"
#include "sim/world/world.h"

namespace limber::script::calls {

std::int32_t add_route(void* c, const char* name, std::int32_t length, const char* from, std::int32_t from_length,
                       const char* to, std::int32_t to_length) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  const Result<sim::Route*> route = context.world->behaviors().routes().add(
      std::string(text_of(name, length)), std::string(text_of(from, from_length)), std::string(text_of(to, to_length)));
  return route ? context.set_id((*route)->id()) : context.reject(route.error());
}

std::int32_t route_text(void* c, std::int32_t slot, std::int32_t generation, std::int32_t which) {
  ScriptContext& context = context_of(c);
  const sim::Route* const route = object_of<sim::Route>(context, id_of(slot, generation));
  if (route == nullptr) return kRemoved;
  return context.set_text(which == 0 ? route->from() : which == 1 ? route->to() : route->problem());
}

std::int32_t node_path(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const NodeId id = id_of(slot, generation);
  if (!context.alive(id)) return kRemoved;
  return context.set_text(context.world->store().path(id));
}

}  // namespace limber::script::calls
