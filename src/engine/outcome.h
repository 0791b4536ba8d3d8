// Outcome: what became of a message.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"
#include "params/table.h"

namespace limber {

struct Outcome {
  enum class Kind : std::uint8_t {
    applied,
    answered,  ///< `answers` go to the sender.
    refused,   ///< `error` says why; nothing was changed.
    unknown,   ///< No such address of Limber's; `error` names near ones.
    takes,     ///< It is about takes: for the engine, at the tick's end.
    scenes,    ///< It is about the show's scenes: for who may read files (EngineLink::ask_scenes), and who answers.
  };
  Kind kind = Kind::applied;
  bool kept = false;             ///< It set a property: a performer's value, which a reset keeps.
  const Row* clamped = nullptr;  ///< A row whose range the value was outside of.
  std::string error;
  std::string said;  ///< What was left out of what was done.
  std::vector<Message> answers;

  static Outcome refused(std::string why) {
    Outcome outcome;
    outcome.kind = Kind::refused;
    outcome.error = std::move(why);
    return outcome;
  }
  static Outcome unknown(std::string why) {
    Outcome outcome;
    outcome.kind = Kind::unknown;
    outcome.error = std::move(why);
    return outcome;
  }
};

}  // namespace limber
