// Parsing of arguments.
#include "engine/presets/commands.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/presets/presets.h"

namespace limber {

namespace {

std::optional<double> number_of(const Arg& arg) {
  if (arg.is_text()) return parse_number(arg.text);
  if (arg.kind == Arg::Kind::nil || !std::isfinite(arg.number)) return {};
  return arg.number;
}

bool is_preset_reference(const Arg& arg) {
  return arg.is_text() || (arg.kind == Arg::Kind::number && std::isfinite(arg.number));
}

// Parses one word after the name. False if the word is unknown.
bool parse_word(std::string_view word, bool& after_except, PresetSelection& selection) {
  std::vector<std::string>& patterns = after_except ? selection.except : selection.include;
  if (word.starts_with('/')) {
    patterns.emplace_back(word);
  } else if (same_name(word, "behaviors")) {
    patterns.insert(patterns.end(), {"/physics/body/*/behavior//*", "/physics/group//*"});
  } else if (same_name(word, "looks")) {
    patterns.emplace_back("/visuals//*");
  } else if (same_name(word, "poses")) {
    selection.poses = true;
  } else if (same_name(word, "velocities")) {
    selection.velocities = true;
  } else if (same_name(word, "except")) {
    after_except = true;
  } else {
    return same_name(word, "all");
  }
  return true;
}

}  // namespace

Result<StoreCommand> parse_store(const Message& message) {
  const std::vector<Arg>& args = message.args;
  if (args.empty() || !is_preset_reference(args[0]))
    return Error{"expected a name, and optionally the properties to store"};
  StoreCommand command;
  if (args[0].is_text()) {
    command.name = args[0].text;
    if (const auto fault = name_error(command.name)) return Error{fmt::format("invalid name: {}", *fault)};
    if (command.name == "script") return Error{"'script' is reserved for the values of the scene; use another name"};
  } else {
    command.number = args[0].number;
  }
  bool after_except = false;
  for (std::size_t i = 1; i < args.size(); i++) {
    if (!command.selection) command.selection.emplace();
    if (args[i].is_text() && parse_word(args[i].text, after_except, *command.selection)) continue;
    return Error{
        fmt::format("unknown word '{}'; expected path patterns, behaviors, looks, all, poses, "
                    "velocities, except",
                    args[i].is_text() ? printable(shortened(args[i].text, 100)) : number_text(args[i].number))};
  }
  return command;
}

Result<RecallCommand> parse_recall(const Message& message) {
  const std::vector<Arg>& args = message.args;
  if (args.empty() || args.size() > 3 || !is_preset_reference(args[0]))
    return Error{"expected a name or a number, optionally seconds and an easing: " + std::string(easing_names())};
  RecallCommand command{args[0], 0, Easing::smooth};
  if (args.size() > 1) {
    const std::optional<double> seconds = number_of(args[1]);
    if (!seconds || *seconds < 0 || *seconds > Presets::kMaxMorphSeconds)
      return Error{fmt::format("the duration must be 0 to {} s", Presets::kMaxMorphSeconds)};
    command.seconds = *seconds;
  }
  if (args.size() > 2) {
    const std::optional<Easing> easing = args[2].is_text() ? easing_of(args[2].text) : std::nullopt;
    if (!easing) {
      return Error{fmt::format("unknown easing '{}'; expected one of: {}",
                               args[2].is_text() ? printable(shortened(args[2].text, 40)) : number_text(args[2].number),
                               easing_names())};
    }
    command.easing = *easing;
  }
  return command;
}

Result<MorphCommand> parse_morph(const Message& message) {
  const std::vector<Arg>& args = message.args;
  const std::optional<double> amount = args.size() == 3 ? number_of(args[2]) : std::nullopt;
  if (!amount || !is_preset_reference(args[0]) || !is_preset_reference(args[1]))
    return Error{"expected two presets and an amount from 0 to 1"};
  return MorphCommand{args[0], args[1], std::clamp(*amount, 0.0, 1.0)};
}

}  // namespace limber
