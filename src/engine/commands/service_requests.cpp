// The arguments of requests about MIDI and OSC targets.
#include "engine/commands/service_requests.h"

#include <algorithm>

#include "base/text.h"

namespace limber::engine {

namespace {

Outcome request(Outcome::Kind kind) {
  Outcome outcome;
  outcome.kind = kind;
  return outcome;
}

Outcome check_midi_request(const Message& message, bool learns) {
  constexpr std::size_t kMostArguments = 3;
  const std::vector<Arg>& args = message.args;
  const bool cancels = learns && args.empty();
  const bool named = !args.empty() && args[0].is_text();
  const bool complete = std::ranges::all_of(args, [](const Arg& arg) { return arg.is_numeric() || arg.is_text(); });
  const bool fits = args.size() <= (learns ? kMostArguments : kMostArguments - 1);
  if (!cancels && !(named && complete && fits))
    return Outcome::rejected(learns ? "takes an address, then the number of a component or a mode; or nothing"
                                    : "takes an address, and possibly the number of a component");
  return request(Outcome::Kind::midi_request);
}

}  // namespace

Outcome check_service_request(const Message& message) {
  const std::vector<Arg>& args = message.args;
  const auto is = [&](std::string_view address) { return same_address(message.address, address); };
  if (is("/midi/learn") || is("/midi/forget")) return check_midi_request(message, is("/midi/learn"));
  const bool texts = std::ranges::all_of(args, [](const Arg& arg) { return arg.is_text(); });
  if (is("/osc/target/add")) {
    if (args.empty() || !texts) return Outcome::rejected("takes HOST:PORT and settings as texts, such as rate=30");
  } else if (is("/osc/target/remove")) {
    if (args.size() != 1 || !texts) return Outcome::rejected("takes HOST:PORT; /list/targets lists the targets");
  } else if (!args.empty() && (args.size() > 1 || args[0].is_text())) {
    return Outcome::rejected("takes no arguments");
  } else if (args.size() == 1 && args[0].is_numeric() && args[0].number == 0) {
    return {};  // a button is released
  }
  return request(Outcome::Kind::osc_request);
}

}  // namespace limber::engine
