// Arguments to wishes.
#include "engine/preset_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/presets.h"

namespace limber {

namespace {

std::optional<double> number_in(const Arg& arg) {
  if (arg.is_text()) return parse_number(arg.text);
  if (arg.kind == Arg::Kind::nil || !std::isfinite(arg.number)) return {};
  return arg.number;
}

bool is_which(const Arg& arg) { return arg.is_text() || (arg.kind == Arg::Kind::number && std::isfinite(arg.number)); }

// one word after the name; false: there is no such word
bool take_word(std::string_view word, bool& excepting, PresetChoice& choice) {
  std::vector<std::string>& patterns = excepting ? choice.except : choice.rows;
  if (word.starts_with('/')) {
    patterns.emplace_back(word);
  } else if (same_name(word, "behaviors")) {
    patterns.insert(patterns.end(), {"/physics/body/*/behavior//*", "/physics/group//*"});
  } else if (same_name(word, "looks")) {
    patterns.emplace_back("/visuals//*");
  } else if (same_name(word, "poses")) {
    choice.poses = true;
  } else if (same_name(word, "velocities")) {
    choice.velocities = true;
  } else if (same_name(word, "except")) {
    excepting = true;
  } else {
    return same_name(word, "all");
  }
  return true;
}

}  // namespace

Result<StoreWish> store_wish(const Message& message) {
  const std::vector<Arg>& args = message.args;
  if (args.empty() || !is_which(args[0])) return Error{"takes a name, and what is kept if that is not all"};
  StoreWish wish;
  if (args[0].is_text()) {
    wish.name = args[0].text;
    if (const auto fault = name_fault(wish.name)) return Error{fmt::format("this is no name: {}", *fault)};
    if (wish.name == "script") return Error{"'script' is what the scene describes; take another name"};
  } else {
    wish.number = args[0].number;
  }
  bool excepting = false;
  for (std::size_t i = 1; i < args.size(); i++) {
    if (!wish.choice) wish.choice.emplace();
    if (args[i].is_text() && take_word(args[i].text, excepting, *wish.choice)) continue;
    return Error{
        fmt::format("'{}' is none of the words behind the name: patterns of paths, behaviors, looks, all, poses, "
                    "velocities, except",
                    args[i].is_text() ? printable(shortened(args[i].text, 100)) : number_text(args[i].number))};
  }
  return wish;
}

Result<RecallWish> recall_wish(const Message& message) {
  const std::vector<Arg>& args = message.args;
  if (args.empty() || args.size() > 3 || !is_which(args[0]))
    return Error{"takes a name or a number, seconds if it is to take some, and how: " + std::string(easing_names())};
  RecallWish wish{args[0], 0, Easing::smooth};
  if (args.size() > 1) {
    const std::optional<double> seconds = number_in(args[1]);
    if (!seconds || *seconds < 0 || *seconds > Presets::kLongest)
      return Error{fmt::format("takes 0 to {} seconds behind the name", Presets::kLongest)};
    wish.seconds = *seconds;
  }
  if (args.size() > 2) {
    const std::optional<Easing> easing = args[2].is_text() ? easing_of(args[2].text) : std::nullopt;
    if (!easing) {
      return Error{fmt::format("'{}' is no easing; there are: {}",
                               args[2].is_text() ? printable(shortened(args[2].text, 40)) : number_text(args[2].number),
                               easing_names())};
    }
    wish.easing = *easing;
  }
  return wish;
}

Result<MorphWish> morph_wish(const Message& message) {
  const std::vector<Arg>& args = message.args;
  const std::optional<double> amount = args.size() == 3 ? number_in(args[2]) : std::nullopt;
  if (!amount || !is_which(args[0]) || !is_which(args[1]))
    return Error{"takes two presets and how far from the first to the second, 0 to 1"};
  return MorphWish{args[0], args[1], std::clamp(*amount, 0.0, 1.0)};
}

}  // namespace limber
