// C API: presets.
#include "script/api/script_context.h"

namespace limber::script::calls {

std::int32_t request_preset(void* c) {
  ScriptContext& context = context_of(c);
  const Result<void> allowed = context.host.check_preset(context.arguments.message, context.effects.presets());
  if (!allowed) return context.reject(allowed.error());
  context.effects.request_preset(std::move(context.arguments.message));
  return kOk;
}

void preset_names(void* c) {
  std::string names;
  for (const std::string& name : context_of(c).host.preset_names()) names += name + "\n";
  context_of(c).set_text(std::move(names));
}

}  // namespace limber::script::calls
