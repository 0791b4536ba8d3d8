// ScriptHost: what a scene may ask of the outside. The engine implements it; scripts never see a socket. [sim]
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/osc_plan.h"
#include "base/output.h"
#include "base/result.h"

namespace limber {

class ScriptHost {
 public:
  virtual ~ScriptHost() = default;

  /// osc:send — to every target.
  virtual void send(Message message) = 0;
  /// osc:reply — to the sender of the message that is being handled.
  virtual void reply(const Origin& to, Message message) = 0;
  /// osc:to("host:port"):send.
  virtual void send_direct(const Origin& to, Message message) = 0;
  /// What the scene's run said by osc:listen and osc:stream_to; called once, after a good run.
  virtual void plan_osc(const OscPlan& plan) = 0;
  /// sim:reset() from a callback: done between two ticks.
  virtual void ask_reset() = 0;
  /// sim:panic() from a callback: done before the next step.
  virtual void ask_panic() {}
  /// presets:store, recall, morph, delete from a callback, as the message that means it: whether it would be taken,
  /// were those of `before` done.
  virtual Result<void> check_preset(const Message& wish, std::span<const Message> before) {
    (void)wish, (void)before;
    return Error{"there are no presets here"};
  }
  /// One that would is done once the tick's callbacks are.
  virtual void ask_preset(Message&& wish) { (void)wish; }
  /// Their names, in order.
  virtual std::vector<std::string> preset_names() { return {}; }
  /// A script's fault, with file and line: log, panel, /script/error. Empty text: the file is mended.
  virtual void script_error(std::string_view file, int line, std::string_view text) = 0;
  /// print(…): a line of text, as it is, to stdout. A run beside the show prints too. [any]
  virtual void print(std::string_view text) { write_line(OutputTo::out, text); }
};

}  // namespace limber
