// Parses cue files.
#include "engine/cues/cue_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "engine/cues/json_text.h"
#include "engine/presets/presets.h"

namespace limber::engine {

namespace {

using CueJson = nlohmann::json;

constexpr const char* kCueVersionKey = "limber cues";
constexpr int kCueVersion = 1;
constexpr int kMaxCueDepth = 8;  // of nested values
constexpr std::array<std::string_view, 10> kCueFields = {"name", "preset", "time",  "easing", "messages",
                                                         "at",   "when",   "begin", "follow", "note"};
constexpr std::array<std::string_view, 3> kCueStarts = {"now", "beat", "bar"};  // in the order of CueStart

// Parses one cue. Errors begin with the name of the field.
class CueParser {
 public:
  Result<Cue> parse(const CueJson& json) {
    if (!json.is_object()) return Error{"must be an object, such as {\"name\": \"opening\"}"};
    if (const Result<void> known = check_fields(json); !known) return Error{known.error()};
    for (const Result<void>& field :
         {parse_name(json), parse_preset(json), parse_messages(json), parse_start(json),
          parse_seconds(json, "follow", cue_.follow), parse_seconds(json, "begin", cue_.begin)}) {
      if (!field) return Error{field.error()};
    }
    return std::move(cue_);
  }

 private:
  static Result<void> check_fields(const CueJson& json) {
    for (const auto& item : json.items()) {
      if (std::ranges::find(kCueFields, item.key()) != kCueFields.end()) continue;
      const std::string hint = name_hint(item.key(), kCueFields);
      return Error{fmt::format("there is no field '{}'{}", printable(shortened(item.key(), 100)), hint)};
    }
    return {};
  }

  // Returns the value of a field; null if it isn't given or is null.
  static const CueJson* find(const CueJson& json, const char* field) {
    const auto found = json.find(field);
    return found == json.end() || found->is_null() ? nullptr : &*found;
  }

  static Result<void> parse_text(const CueJson& json, const char* field, std::string& to) {
    const CueJson* const value = find(json, field);
    if (value == nullptr) return {};
    if (!value->is_string()) return Error{fmt::format("{}: must be a text in quotes", field)};
    to = value->get<std::string>();
    if (to.size() > Cue::kMaxText) return Error{fmt::format("{}: must have at most {} bytes", field, Cue::kMaxText)};
    return {};
  }

  Result<void> parse_name(const CueJson& json) {
    if (Result<void> text = parse_text(json, "name", cue_.name); !text) return text;
    if (const auto fault = name_error(cue_.name)) return Error{fmt::format("name: {}", *fault)};
    return parse_text(json, "note", cue_.note);
  }

  Result<void> parse_preset(const CueJson& json) {
    if (Result<void> text = parse_text(json, "preset", cue_.preset); !text) return text;
    if (const CueJson* const time = find(json, "time")) {
      const double seconds = time->is_number() ? time->get<double>() : -1;
      if (!(seconds >= 0 && seconds <= Presets::kMaxMorphSeconds))
        return Error{fmt::format("time: must be a number of seconds from 0 to {}", Presets::kMaxMorphSeconds)};
      cue_.time = seconds;
    }
    std::string easing;
    if (Result<void> text = parse_text(json, "easing", easing); !text) return text;
    if (easing.empty()) return {};
    const std::optional<Easing> known = easing_of(easing);
    if (!known)
      return Error{fmt::format("easing: unknown easing '{}'; expected one of: {}", printable(shortened(easing, 100)),
                               easing_names())};
    cue_.easing = *known;
    return {};
  }

  Result<void> parse_start(const CueJson& json) {
    std::string at;
    if (Result<void> text = parse_text(json, "at", at); !text) return text;
    const auto known = std::ranges::find(kCueStarts, at);
    if (!at.empty() && known == kCueStarts.end())
      return Error{fmt::format("at: must be \"now\", \"beat\" or \"bar\", not '{}'", printable(shortened(at, 100)))};
    if (!at.empty()) cue_.at = static_cast<CueStart>(known - kCueStarts.begin());
    if (Result<void> text = parse_text(json, "when", cue_.when); !text) return text;
    if (cue_.when.empty()) return {};
    if (const Result<void> address = check_address(cue_.when); !address)
      return Error{fmt::format("when: {}", address.error())};
    return {};
  }

  static Result<void> parse_seconds(const CueJson& json, const char* field, std::optional<double>& to) {
    const CueJson* const value = find(json, field);
    if (value == nullptr) return {};
    const double seconds = value->is_number() ? value->get<double>() : -1;
    if (!(seconds >= 0 && seconds <= Cue::kMaxFollowSeconds))
      return Error{fmt::format("{}: must be a number of seconds from 0 to {}, or null", field, Cue::kMaxFollowSeconds)};
    to = seconds;
    return {};
  }

  Result<void> parse_messages(const CueJson& json) {
    const CueJson* const messages = find(json, "messages");
    if (messages == nullptr) return {};
    if (!messages->is_array()) return Error{"messages: must be a list, such as [[\"/lighting/blackout\", 1]]"};
    if (messages->size() > Cue::kMaxMessages)
      return Error{fmt::format("messages: at most {} in a cue; split it into several cues", Cue::kMaxMessages)};
    for (const CueJson& message : *messages) {
      Result<Message> parsed = parse_message(message);
      if (!parsed) return Error{fmt::format("messages: {}: {}", cue_.messages.size() + 1, parsed.error())};
      cue_.messages.push_back(std::move(*parsed));
    }
    return {};
  }

  static Result<void> check_address(const std::string& text) {
    const std::string address = normalized_name(text);
    if (!address.starts_with('/') || address.size() > Cue::kMaxText || printable(address) != address)
      return Error{fmt::format("'{}' is not an address; it must begin with /", printable(shortened(text, 100)))};
    if (address.starts_with("/cue/"))
      return Error{"a cue can't control the cue list; set follow to continue with the next cue"};
    return {};
  }

  static Result<Message> parse_message(const CueJson& json) {
    if (!json.is_array() || json.empty() || !json[0].is_string())
      return Error{"must be a list of an address and its values, such as [\"/lighting/blackout\", 1]"};
    Message message{json[0].get<std::string>(), {}};
    if (const Result<void> address = check_address(message.address); !address) return Error{address.error()};
    if (json.size() > Cue::kMaxArguments + 1)
      return Error{fmt::format("at most {} values in a message", Cue::kMaxArguments)};
    for (std::size_t i = 1; i < json.size(); i++) {
      std::optional<Arg> arg = arg_of(json[i]);
      if (!arg) return Error{fmt::format("value {} must be a number, true, false, a short text or null", i)};
      message.args.push_back(std::move(*arg));
    }
    return message;
  }

  static std::optional<Arg> arg_of(const CueJson& json) {
    if (json.is_null()) return Arg{};
    if (json.is_boolean()) return Arg::of(json.get<bool>());
    if (json.is_number() && std::isfinite(json.get<double>())) return Arg::of(json.get<double>());
    if (json.is_string() && json.get_ref<const std::string&>().size() <= Cue::kMaxText)
      return Arg::of(std::string_view(json.get_ref<const std::string&>()));
    return std::nullopt;
  }

  Cue cue_;
};

// Returns "cue 3", or "cue 3 'sunset'".
std::string cue_text(std::size_t number, const CueJson& json) {
  const bool named = json.is_object() && json.contains("name") && json["name"].is_string();
  if (!named) return fmt::format("cue {}", number);
  return fmt::format("cue {} '{}'", number, printable(shortened(json["name"].get<std::string>(), 100)));
}

Result<void> check_header(const CueJson& json) {
  const bool has_version = json.is_object() && json.contains(kCueVersionKey) && json[kCueVersionKey].is_number();
  if (!has_version || !json.contains("cues") || !json["cues"].is_array())
    return Error{fmt::format("not a cue file; expected {{\"{}\": {}, \"cues\": [ … ]}}", kCueVersionKey, kCueVersion)};
  if (json[kCueVersionKey].get<double>() > kCueVersion)
    return Error{
        fmt::format("it was written by a newer version of Limber; \"{}\" must be {}", kCueVersionKey, kCueVersion)};
  if (json["cues"].size() > kMaxCues) return Error{fmt::format("at most {} cues", kMaxCues)};
  return {};
}

}  // namespace

std::span<const std::string_view> cue_starts() { return kCueStarts; }

Result<CueList> parse_cues(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return CueList{};
  const Result<CueJson> json = parse_json_text(text, kMaxCueDepth);
  if (!json) return Error{json.error()};
  if (const Result<void> header = check_header(*json); !header) return Error{header.error()};
  CueList cues;
  for (const CueJson& entry : (*json)["cues"]) {
    const std::string place = cue_text(cues.size() + 1, entry);
    Result<Cue> cue = CueParser().parse(entry);
    if (!cue) return Error{fmt::format("{}: {}", place, cue.error())};
    if (std::ranges::find(cues, cue->name, &Cue::name) != cues.end())
      return Error{fmt::format("{}: name: another cue has the same name", place)};
    if (cue->begin && !cues.empty()) return Error{fmt::format("{}: begin: only the first cue has it", place)};
    cues.push_back(std::move(*cue));
  }
  return cues;
}

std::vector<Message> messages_of(const Cue& cue) {
  std::vector<Message> messages;
  if (!cue.preset.empty()) {
    const std::string easing = easings()[static_cast<std::size_t>(cue.easing)];
    messages.push_back({"/preset/recall", {Arg::of(std::string_view(cue.preset)), Arg::of(cue.time), Arg::of(easing)}});
  }
  messages.insert(messages.end(), cue.messages.begin(), cue.messages.end());
  return messages;
}

}  // namespace limber::engine
