// MidiMap: reads and writes its file.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "engine/cues/json_text.h"
#include "net/midi/map.h"

namespace limber::midi {

namespace {

using MapJson = nlohmann::json;

constexpr const char* kMapVersionKey = "limber midi";
constexpr int kMapVersion = 1;
constexpr int kMaxMapDepth = 6;  // of nested values
constexpr std::array<std::string_view, 13> kMapFields = {"port",      "channel", "kind", "number", "address",
                                                         "component", "range",   "mode", "step",   "takeover",
                                                         "feedback",  "values",  "note"};

// Parses one entry. Errors begin with the name of the field.
class EntryParser {
 public:
  explicit EntryParser(const MapJson& json) : json_(json) {}

  Result<MidiEntry> parse() {
    if (!json_.is_object())
      return Error{R"(must be an object, such as {"kind": "cc", "number": 7, "address": "/scene/wind"})"};
    if (const Result<void> known = check_fields(); !known) return Error{known.error()};
    using Step = Result<void> (EntryParser::*)();
    for (const Step step : {&EntryParser::parse_control, &EntryParser::parse_address, &EntryParser::parse_range,
                            &EntryParser::parse_behavior, &EntryParser::parse_values}) {
      if (const Result<void> done = (this->*step)(); !done) return Error{done.error()};
    }
    return std::move(entry_);
  }

 private:
  Result<void> check_fields() const {
    for (const auto& item : json_.items()) {
      if (std::ranges::find(kMapFields, item.key()) != kMapFields.end()) continue;
      const std::string hint = name_hint(item.key(), kMapFields);
      return Error{fmt::format("there is no field '{}'{}", printable(shortened(item.key(), 100)), hint)};
    }
    return {};
  }

  // Returns the value of a field; null if it isn't given or is null.
  const MapJson* find(const char* field) const {
    const auto found = json_.find(field);
    return found == json_.end() || found->is_null() ? nullptr : &*found;
  }

  Result<void> parse_text(const char* field, std::string& to) const {
    const MapJson* const value = find(field);
    if (value == nullptr) return {};
    if (!value->is_string()) return Error{fmt::format("{}: must be a text in quotes", field)};
    to = value->get<std::string>();
    if (to.size() > MidiEntry::kMaxText)
      return Error{fmt::format("{}: must have at most {} bytes", field, MidiEntry::kMaxText)};
    return {};
  }

  // A whole number from low to high.
  Result<void> parse_integer(const char* field, int low, int high, int& to) const {
    const MapJson* const value = find(field);
    if (value == nullptr) return {};
    const double number = value->is_number() ? value->get<double>() : low - 1.0;
    if (!(number >= low && number <= high && std::floor(number) == number))
      return Error{fmt::format("{}: must be a whole number from {} to {}", field, low, high)};
    to = static_cast<int>(number);
    return {};
  }

  template <std::size_t Count>
  static std::string name_fault(const char* field, std::string_view name,
                                const std::array<std::string_view, Count>& names) {
    return fmt::format("{}: unknown {} '{}'; expected one of: {}", field, field, printable(shortened(name, 100)),
                       fmt::join(names, ", "));
  }

  Result<void> parse_control() {
    if (Result<void> port = parse_text("port", entry_.port); !port) return port;
    if (Result<void> channel = parse_integer("channel", 1, 16, entry_.channel); !channel) return channel;
    std::string kind;
    if (Result<void> text = parse_text("kind", kind); !text) return text;
    const std::optional<ControlKind> known = control_kind_of(kind);
    if (!known) return Error{name_fault("kind", kind, kControlKindNames)};
    entry_.kind = *known;
    const int highest = max_number(entry_.kind);
    if (highest > 0 && find("number") == nullptr)
      return Error{fmt::format("number: must be given, a whole number from 0 to {}", highest)};
    if (highest == 0 && find("number") != nullptr)
      return Error{fmt::format("number: {} has no number; leave it out", kind)};
    return parse_integer("number", 0, highest, entry_.number);
  }

  Result<void> parse_address() {
    if (Result<void> text = parse_text("address", entry_.address); !text) return text;
    if (!entry_.address.starts_with('/') || printable(entry_.address) != entry_.address)
      return Error{fmt::format("address: '{}' is not an address; it must begin with /",
                               printable(shortened(entry_.address, 100)))};
    if (normalized_name(entry_.address).starts_with("/midi/"))
      return Error{"address: a control can't learn or forget other controls; name another address"};
    if (Result<void> component = parse_integer("component", 1, 4, entry_.component); !component) return component;
    return parse_text("note", entry_.note);
  }

  Result<void> parse_range() {
    const MapJson* const range = find("range");
    if (range == nullptr) return {};
    std::array<double, 2> ends{};
    bool valid = range->is_array() && range->size() == 2;
    for (std::size_t i = 0; valid && i < 2; i++) {
      valid = (*range)[i].is_number() && std::isfinite((*range)[i].get<double>());
      if (valid) ends[i] = (*range)[i].get<double>();
    }
    if (!valid || ends[0] == ends[1]) return Error{"range: must be a list of two different numbers, such as [0, 1]"};
    entry_.range = ends;
    return {};
  }

  Result<void> parse_behavior() {
    std::string mode;
    if (Result<void> text = parse_text("mode", mode); !text) return text;
    entry_.mode = control_mode_of(mode);
    if (!mode.empty() && !entry_.mode) return Error{name_fault("mode", mode, kControlModeNames)};
    const bool seven_bits = max_value(entry_.kind) == 127;
    if (entry_.mode && is_relative(*entry_.mode) && !seven_bits)
      return Error{fmt::format("mode: {} has no relative values; use cc", control_kind_name(entry_.kind))};
    if (const MapJson* const step = find("step")) {
      const double size = step->is_number() ? step->get<double>() : 0;
      if (size == 0 || !std::isfinite(size)) return Error{"step: must be a number other than 0"};
      entry_.step = size;
    }
    return parse_takeover();
  }

  Result<void> parse_takeover() {
    std::string takeover;
    if (Result<void> text = parse_text("takeover", takeover); !text) return text;
    constexpr std::array<std::string_view, 2> kTakeovers = {"pickup", "jump"};
    if (!takeover.empty() && std::ranges::find(kTakeovers, takeover) == kTakeovers.end())
      return Error{name_fault("takeover", takeover, kTakeovers)};
    entry_.pickup = takeover != "jump";
    const MapJson* const feedback = find("feedback");
    if (feedback == nullptr) return {};
    if (!feedback->is_boolean()) return Error{"feedback: must be true or false"};
    entry_.feedback = feedback->get<bool>();
    return {};
  }

  Result<void> parse_values() {
    const MapJson* const values = find("values");
    if (values == nullptr) return {};
    if (entry_.mode != ControlMode::trigger)
      return Error{"values: are of the mode trigger only; set \"mode\": \"trigger\""};
    if (!values->is_array() || values->size() > MidiEntry::kMaxArguments)
      return Error{fmt::format("values: must be a list of at most {} values", MidiEntry::kMaxArguments)};
    for (const MapJson& value : *values) {
      std::optional<Arg> arg = argument(value);
      if (!arg)
        return Error{fmt::format("values: {} must be a number, true, false or a short text", entry_.values.size() + 1)};
      entry_.values.push_back(std::move(*arg));
    }
    return {};
  }

  static std::optional<Arg> argument(const MapJson& json) {
    if (json.is_boolean()) return Arg::of(json.get<bool>());
    if (json.is_number() && std::isfinite(json.get<double>())) return Arg::of(json.get<double>());
    if (json.is_string() && json.get_ref<const std::string&>().size() <= MidiEntry::kMaxText)
      return Arg::of(std::string_view(json.get_ref<const std::string&>()));
    return std::nullopt;
  }

  const MapJson& json_;
  MidiEntry entry_;
};

// Returns the offset of the entry with this index: of the opening bracket at the third level.
std::size_t entry_offset(std::string_view text, std::size_t index) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); i++) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') i++;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth == 3 && index-- == 0) return i;
    } else if (c == '}' || c == ']') {
      depth--;
    }
  }
  return 0;
}

Result<void> check_map_header(const MapJson& json) {
  const bool has_version = json.is_object() && json.contains(kMapVersionKey) && json[kMapVersionKey].is_number();
  if (!has_version || !json.contains("entries") || !json["entries"].is_array())
    return Error{
        fmt::format("not a MIDI map; expected {{\"{}\": {}, \"entries\": [ … ]}}", kMapVersionKey, kMapVersion)};
  if (json[kMapVersionKey].get<double>() > kMapVersion)
    return Error{
        fmt::format("it was written by a newer version of Limber; \"{}\" must be {}", kMapVersionKey, kMapVersion)};
  if (json.size() > 2) return Error{fmt::format("it must have \"{}\" and \"entries\" only", kMapVersionKey)};
  if (json["entries"].size() > kMaxEntries) return Error{fmt::format("at most {} entries", kMaxEntries)};
  return {};
}

nlohmann::ordered_json json_of(const Arg& arg) {
  if (arg.is_text()) return arg.text;
  if (arg.kind == Arg::Kind::boolean) return arg.number != 0;
  return arg.number;
}

// The fields in the order in which people read them.
nlohmann::ordered_json json_of(const MidiEntry& entry) {
  nlohmann::ordered_json json;
  if (!entry.port.empty()) json["port"] = entry.port;
  if (entry.channel > 0) json["channel"] = entry.channel;
  json["kind"] = control_kind_name(entry.kind);
  if (max_number(entry.kind) > 0) json["number"] = entry.number;
  json["address"] = entry.address;
  if (entry.component > 0) json["component"] = entry.component;
  if (entry.range) json["range"] = {(*entry.range)[0], (*entry.range)[1]};
  if (entry.mode) json["mode"] = control_mode_name(*entry.mode);
  if (entry.step) json["step"] = *entry.step;
  if (!entry.pickup) json["takeover"] = "jump";
  if (entry.feedback) json["feedback"] = *entry.feedback;
  for (const Arg& arg : entry.values) json["values"].push_back(json_of(arg));
  if (!entry.note.empty()) json["note"] = entry.note;
  return json;
}

}  // namespace

Result<MidiMap> parse_midi_map(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return MidiMap{};
  const Result<MapJson> json = engine::parse_json_text(text, kMaxMapDepth);
  if (!json) return Error{json.error()};
  if (const Result<void> header = check_map_header(*json); !header) return Error{header.error()};
  MidiMap map;
  for (const MapJson& each : (*json)["entries"]) {
    Result<MidiEntry> entry = EntryParser(each).parse();
    if (!entry) {
      // only objects and lists count as entries in the text
      const bool at_bracket = std::ranges::all_of((*json)["entries"], &MapJson::is_structured);
      const std::string line = engine::line_of(text, at_bracket ? entry_offset(text, map.size()) : 0);
      return Error{fmt::format("{}entry {}: {}", at_bracket ? line + ", " : "", map.size() + 1, entry.error())};
    }
    map.push_back(std::move(*entry));
  }
  return map;
}

std::string midi_map_text(const MidiMap& map) {
  std::string text = fmt::format("{{\n  \"{}\": {},\n  \"entries\": [", kMapVersionKey, kMapVersion);
  for (const MidiEntry& entry : map) {
    text += &entry == map.data() ? "\n    " : ",\n    ";
    text += json_of(entry).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }
  return text + (map.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace limber::midi
