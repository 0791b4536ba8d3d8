// RecordedInput: executes recorded inputs of a pass again, for the replay of a take or a rewind. [sim]
#pragma once

#include <optional>
#include <span>

#include "engine/commands/command_executor.h"

namespace limber::engine {

class RecordedInput : public InputSource {
 public:
  bool may_call_handler(std::uint64_t called) const override { return !handler_calls_ || called < *handler_calls_; }
  void end_handlers(std::uint64_t) override { handler_calls_.reset(); }

 protected:
  RecordedInput(ShowState& show, CommandExecutor& executor) : show_(show), executor_(executor) {}
  /// Executes messages, console texts and events (TakeEvent). Moves parts of them.
  void execute(std::span<InputRecord> inputs);
  ShowState& show() const { return show_; }

 private:
  bool execute_event(const Message& message);

  ShowState& show_;
  CommandExecutor& executor_;
  std::optional<std::uint64_t> handler_calls_;  // number of handler calls in this pass; nothing: all
};

}  // namespace limber::engine
