// Behind the door: what scripts ask of presets.
#include "script/context.h"

namespace limber::calls {

std::int32_t preset_ask(void* c) {
  ScriptContext& context = context_of(c);
  const Result<void> may = context.host.check_preset(context.message, context.preset_wishes);
  if (!may) return context.refuse(may.error());
  context.preset_wishes.push_back(std::move(context.message));
  return kOk;
}

void preset_names(void* c) {
  std::string names;
  for (const std::string& name : context_of(c).host.preset_names()) names += name + "\n";
  context_of(c).say(std::move(names));
}

}  // namespace limber::calls
