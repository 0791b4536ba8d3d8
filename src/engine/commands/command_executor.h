// CommandExecutor: executes messages and console texts, and reports their results to the senders. [sim]
#pragma once

#include "engine/show_state.h"

namespace limber::engine {

class CommandExecutor {
 public:
  explicit CommandExecutor(ShowState& show) : show_(show) {}

  struct Execution {
    int work = 0;          ///< Cost in units of LiveInput::kPassWork, in addition to 1.
    bool rewound = false;  ///< The message was a request to rewind.
    bool applied = false;  ///< It set a value or called an action.
  };
  /// Executes a message of `source` and reports the result. Queues it for the handlers of the scene, which are called
  /// after all messages of the pass have taken effect.
  Execution execute(Message& message, const CommandOrigin& origin, InputSource& source);
  /// Runs a Lua text or completes its last word. An error in the text is returned to its author and is not counted as a
  /// fault of the show.
  void evaluate(const EvaluationRequest& request, const CommandOrigin& origin, InputSource& source);

 private:
  void report(Outcome& outcome, const Message& message, const CommandOrigin& origin);
  void queue_for_handlers(Outcome& outcome, Message& message, const CommandOrigin& origin);
  Evaluation evaluate_text(std::string_view text);

  ShowState& show_;
};

}  // namespace limber::engine
