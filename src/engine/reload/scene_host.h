// SceneHost: the services of the engine for the scripts of the running show. [sim, except print()]
#pragma once

#include <string>
#include <vector>

#include "engine/reload/scene_reloader.h"
#include "engine/show_state.h"

namespace limber::engine {

class SceneHost final : public script::ScriptHost {
 public:
  /// `reloader` is only used once the scene runs.
  SceneHost(ShowState& show, SceneReloader& reloader) : show_(show), reloader_(reloader) {}

  void send(Message message) override;
  void reply(const CommandOrigin& to, Message message) override;
  void send_direct(const CommandOrigin& to, Message message) override;
  void configure_osc(const OscConfig& config) override { show_.output().configure_osc(config); }
  void request_reset() override { show_.session->world.requests().reset = true; }
  void request_panic() override { show_.session->world.requests().panic = true; }
  Result<void> check_preset(const Message& request, std::span<const Message> earlier) override;
  void request_preset(Message&& request) override { show_.preset_requests.push_back(std::move(request)); }
  std::vector<std::string> preset_names() override;
  void script_error(std::string_view file, int line, std::string_view text) override;
  void print(std::string_view text) override;

 private:
  ShowState& show_;
  SceneReloader& reloader_;
};

}  // namespace limber::engine
