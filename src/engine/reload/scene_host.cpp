// SceneHost: messages, errors and presets of scripts.
#include "engine/reload/scene_host.h"

#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"

namespace limber::engine {

namespace {
constexpr std::size_t kMaxPresetCommands = 256;  // preset commands of scripts per tick
}

void SceneHost::send(Message message) { show_.output().push({Outgoing::Destination::targets, {}, std::move(message)}); }

void SceneHost::reply(const CommandOrigin& to, Message message) {
  show_.output().push({Outgoing::Destination::reply, to, std::move(message)});
}

void SceneHost::send_direct(const CommandOrigin& to, Message message) {
  show_.output().push({Outgoing::Destination::direct, to, std::move(message)});
}

Result<void> SceneHost::check_preset(const Message& request, std::span<const Message> earlier) {
  // commands of earlier calls are still pending
  std::vector<Message> all = show_.preset_requests;
  all.insert(all.end(), earlier.begin(), earlier.end());
  if (all.size() >= kMaxPresetCommands)
    return Error{fmt::format("more than {} preset commands in a tick", kMaxPresetCommands)};
  return show_.presets.check(request, all);
}

std::vector<std::string> SceneHost::preset_names() {
  std::vector<std::string> names;
  for (const auto& preset : show_.presets.list()) names.push_back(preset->name);
  return names;
}

void SceneHost::script_error(std::string_view file, int line, std::string_view text) {
  const bool reported = show_.output().report_script_error(file, line, text);
  if (reported && !text.empty()) reloader_.note_error(file);
}

void SceneHost::print(std::string_view text) { log_print(text, show_.options.print ? OutputTo::out : OutputTo::error); }

}  // namespace limber::engine
