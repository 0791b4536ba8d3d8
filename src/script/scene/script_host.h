// ScriptHost: services that a scene may request from the engine, which implements this interface. [sim]
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/log/output.h"
#include "base/message.h"
#include "base/osc_config.h"
#include "base/result.h"

namespace limber::script {

class ScriptHost {
 public:
  virtual ~ScriptHost() = default;

  /// osc:send — sends to all targets.
  virtual void send(Message message) = 0;
  /// osc:reply — sends to the sender of the message being handled.
  virtual void reply(const CommandOrigin& to, Message message) = 0;
  /// osc:to("host:port"):send.
  virtual void send_direct(const CommandOrigin& to, Message message) = 0;
  /// Ports and targets declared by osc:listen and osc:stream_to; called once after a successful run.
  virtual void configure_osc(const OscConfig& config) = 0;
  /// sim:reset() from a callback: carried out between two ticks.
  virtual void request_reset() = 0;
  /// sim:panic() from a callback: carried out before the next step.
  virtual void request_panic() {}
  /// presets:store, recall, morph, delete from a callback, as the equivalent message: checks whether it would be
  /// accepted after those of `earlier`.
  virtual Result<void> check_preset(const Message& request, std::span<const Message> earlier) {
    (void)request, (void)earlier;
    return Error{"there are no presets here"};
  }
  /// Queues a checked request; carried out after the tick's callbacks.
  virtual void request_preset(Message&& request) { (void)request; }
  /// Preset names, sorted.
  virtual std::vector<std::string> preset_names() { return {}; }
  /// Reports a script error with file and line to log, panel and /script/error. Empty text: the error is fixed.
  virtual void script_error(std::string_view file, int line, std::string_view text) = 0;
  /// print(…): writes a line of text unchanged to stdout. Also called by detached runs. [any]
  virtual void print(std::string_view text) { write_line(OutputTo::out, text); }
};

}  // namespace limber::script
