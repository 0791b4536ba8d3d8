// Memory use of messages, and the /error message.
#include "engine/commands/command.h"

#include "base/text.h"

namespace limber::engine {

std::size_t weight_of(const Message& message) {
  std::size_t bytes = sizeof message + message.address.capacity() + message.args.capacity() * sizeof(Arg);
  for (const Arg& arg : message.args) {
    // short strings are stored in the argument itself
    if (arg.text.capacity() > sizeof(std::string)) bytes += arg.text.capacity();
  }
  return bytes;
}

std::size_t weight_of(const Command& command) {
  std::size_t bytes = sizeof command;
  for (const Message& message : command.messages) bytes += weight_of(message);
  if (command.evaluation != nullptr) bytes += sizeof(EvaluationRequest) + command.evaluation->text.capacity();
  return bytes;
}

std::size_t weight_of(const Outgoing& out) { return sizeof out + weight_of(out.message); }

Message error_message(std::string_view address, std::string_view text) {
  return {"/error", {Arg::of(address), Arg::of(shortened(text, kMaxErrorText))}};
}

}  // namespace limber::engine
