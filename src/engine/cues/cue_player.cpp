// CuePlayer: requests, and the encoding of its state.
#include "engine/cues/cue_player.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::engine {

namespace {

constexpr double kCueEvent = 3;  // after the kinds of TakeEvent, which have another number of arguments
constexpr std::size_t kCueEventArgs = 6;
constexpr double kMaxCueTicks = 2e9;

// Four numbers, the name, and since the second version a number.
bool has_state_types(const std::vector<Arg>& args) {
  const bool named = args[4].is_text() && args[4].text.size() <= Cue::kMaxText;
  return named && std::ranges::all_of(args, [&](const Arg& arg) { return &arg == &args[4] || arg.is_numeric(); });
}

// Without tabs and line ends, which separate the fields.
std::string field_text(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\t' || c == '\n'; }, ' ');
  return text;
}

std::string fields_of(const Cue& cue) {
  return fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}", cue.name, field_text(cue.preset), number_text(cue.time),
                     easings()[static_cast<std::size_t>(cue.easing)], cue_starts()[static_cast<std::size_t>(cue.at)],
                     cue.when, cue.follow ? number_text(*cue.follow) : "", field_text(cue.note));
}

}  // namespace

void CuePlayer::set_list(std::shared_ptr<const CueList> list, std::string file) {
  list_ = std::move(list);
  file_ = std::move(file);
  names_.clear();
  fields_.clear();
  for (const Cue& cue : *list_) {
    names_ += (names_.empty() ? "" : "\n") + cue.name;
    fields_ += (fields_.empty() ? "" : "\n") + fields_of(cue);
  }
}

std::uint32_t CuePlayer::position() const {
  const auto count = static_cast<std::uint32_t>(list_->size());
  if (state_.number == 0) return 0;
  if (state_.number <= count && (*list_)[state_.number - 1].name == state_.name) return state_.number;
  const auto found = std::ranges::find(*list_, state_.name, &Cue::name);
  if (found != list_->end()) return static_cast<std::uint32_t>(found - list_->begin()) + 1;
  return std::min(state_.number, count);
}

std::string CuePlayer::waiting_name() const {
  return state_.waiting > 0 && state_.waiting <= list_->size() ? (*list_)[state_.waiting - 1].name : "";
}

Result<std::size_t> CuePlayer::target(const CueRequest& request) const {
  if (list_->empty()) {
    return Error{file_.empty() ? std::string("there are no cues; put them into a .cues.json file beside the scene")
                               : fmt::format("there are no cues; write them to {}", printable(file_))};
  }
  const std::uint32_t now = position();
  switch (request.kind) {
    case CueRequest::Kind::go:
      if (now >= list_->size()) return Error{"the last cue has run; /cue/jump 1 starts again"};
      return now;
    case CueRequest::Kind::back:
      if (now < 2) return Error{"there is no cue before this one"};
      return now - 2;
    default:
      return find(request.value);
  }
}

Result<std::size_t> CuePlayer::find(const Arg& cue) const {
  std::optional<double> number = cue.number;
  if (cue.is_text()) {
    const auto found = std::ranges::find(*list_, cue.text, &Cue::name);
    if (found != list_->end()) return static_cast<std::size_t>(found - list_->begin());
    number = parse_number(cue.text);
  }
  if (!number) {
    std::vector<std::string_view> names;
    for (const Cue& known : *list_) names.push_back(known.name);
    return Error{
        fmt::format("there is no cue '{}'{}", printable(shortened(cue.text, 100)), name_hint(cue.text, names))};
  }
  if (!(*number >= 1 && *number <= static_cast<double>(list_->size()) && *number == std::floor(*number)))
    return Error{fmt::format("the number of a cue must be 1 to {}, got {}", list_->size(), number_text(*number))};
  return static_cast<std::size_t>(*number) - 1;
}

Message message_of(const CueState& state) {
  return {"",
          {Arg::of(kCueEvent), Arg::of(static_cast<double>(state.number)),
           Arg::of(state.ticks ? static_cast<double>(*state.ticks) : -1.0), Arg::of(state.paused),
           Arg::of(std::string_view(state.name)), Arg::of(static_cast<double>(state.waiting))}};
}

std::optional<CueState> cue_state_of(const Message& message) {
  const std::vector<Arg>& args = message.args;
  // the first version had no cues that wait
  const bool has_waiting = args.size() == kCueEventArgs;
  if (!message.address.empty() || (!has_waiting && args.size() != kCueEventArgs - 1) || args[0].number != kCueEvent)
    return std::nullopt;
  if (!has_state_types(args)) return std::nullopt;
  const double waiting = has_waiting ? args[5].number : 0;
  if (!(waiting >= 0 && waiting <= kMaxCues)) return std::nullopt;
  const double number = args[1].number;
  const double ticks = args[2].number;
  if (!(number >= 0 && number <= kMaxCues) || !(ticks >= -1 && ticks <= kMaxCueTicks)) return std::nullopt;
  CueState state{
      static_cast<std::uint32_t>(number), args[4].text, {}, args[3].number != 0, static_cast<std::uint32_t>(waiting)};
  if (ticks >= 0) state.ticks = static_cast<std::uint32_t>(ticks);
  return state;
}

}  // namespace limber::engine
