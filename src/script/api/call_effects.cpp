// Queuing messages, and applying the effects of a successful call.
#include "script/api/call_effects.h"

#include "script/scene/script_host.h"
#include "sim/world/world.h"

namespace limber::script {

namespace {
constexpr std::size_t kMaxText = std::size_t{1} << 20u;  // bytes per call
}

bool CallEffects::send(Route route, const CommandOrigin& to, Message message) {
  if (messages_.empty()) text_bytes_ = 0;
  for (const Arg& arg : message.args) text_bytes_ += arg.text.size();
  if (messages_.size() >= kMaxMessages || text_bytes_ > kMaxText) return false;
  messages_.push_back({route, to, std::move(message)});
  return true;
}

void CallEffects::apply(sim::World& world, ScriptHost& host) {
  forces.apply(world.force_accumulators());
  for (RoutedMessage& routed : messages_) {
    if (routed.route == Route::all) {
      host.send(std::move(routed.message));
    } else if (routed.route == Route::sender) {
      host.reply(routed.to, std::move(routed.message));
    } else {
      host.send_direct(routed.to, std::move(routed.message));
    }
  }
  for (Message& request : presets_) host.request_preset(std::move(request));
  if (reset_) host.request_reset();
  if (panic_) host.request_panic();
}

void CallEffects::clear() {
  messages_.clear();
  presets_.clear();
}

}  // namespace limber::script
