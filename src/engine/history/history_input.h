// HistoryInput: the inputs of one recorded pass, which a rewind simulates again. [sim]
#pragma once

#include "engine/input/recorded_input.h"

namespace limber::engine {

class HistoryInput final : public RecordedInput {
 public:
  HistoryInput(ShowState& show, CommandExecutor& executor, RecordedPass& pass)
      : RecordedInput(show, executor), pass_(pass) {}

  void execute_messages(bool) override { execute(pass_.messages); }
  bool advances_time(bool) override { return pass_.running; }
  void record(const Message&, const CommandOrigin&, bool) override {}  // the history has it already
  Outcome rewind(const Transport::RewindRequest&, const CommandOrigin&) override {
    return Outcome::rejected("can't rewind while time is rewound");
  }
  Outcome request_take(const Message&) override { return Outcome::answered(); }

 private:
  RecordedPass& pass_;
};

}  // namespace limber::engine
