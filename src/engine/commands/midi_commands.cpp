// The arguments of requests about MIDI.
#include "engine/commands/midi_commands.h"

#include <algorithm>

#include "base/text.h"

namespace limber::engine {

Outcome check_midi_request(const Message& message) {
  constexpr std::size_t kMostArguments = 3;
  const bool learns = same_address(message.address, "/midi/learn");
  const std::vector<Arg>& args = message.args;
  const bool cancels = learns && args.empty();
  const bool named = !args.empty() && args[0].is_text();
  const bool complete = std::ranges::all_of(args, [](const Arg& arg) { return arg.is_numeric() || arg.is_text(); });
  const bool fits = args.size() <= (learns ? kMostArguments : kMostArguments - 1);
  if (!cancels && !(named && complete && fits))
    return Outcome::rejected(learns ? "takes an address, then the number of a component or a mode; or nothing"
                                    : "takes an address, and possibly the number of a component");
  Outcome outcome;
  outcome.kind = Outcome::Kind::midi_request;
  return outcome;
}

}  // namespace limber::engine
