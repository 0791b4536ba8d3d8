// Encoding of the larger parts of a take: header, initial state, ticks, file lists, end.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "engine/presets/text.h"
#include "engine/takes/encoding.h"

namespace limber::engine {

namespace {

void write_map(TakeEncoder& out, const std::map<std::string, std::string>& map) {
  out.varint(map.size());
  for (const auto& [key, value] : map) {
    out.string(key);
    out.string(value);
  }
}

void read_map(TakeDecoder& in, std::map<std::string, std::string>& map) {
  for (std::size_t left = in.count(); left > 0 && !in.failed(); left--) {
    const std::string key(in.string());
    map[key] = in.string();
  }
}

bool read_presets(TakeDecoder& in, PresetList& list) {
  Result<ParsedPresets> read = parse_presets(in.string());
  if (!read || !read->problems.empty()) return false;
  list = std::move(read->presets);
  return true;
}

void write_override(TakeEncoder& out, InputCodec& codec, const TakeOverride& entry) {
  out.byte(static_cast<std::uint8_t>(entry.kind));
  if (entry.kind == TakeOverride::Kind::blend) {
    // each preset is a text of its own: one text can't hold two presets of the same name
    out.varint(entry.presets.size());
    for (const auto& preset : entry.presets) out.string(text_of(PresetList{preset}));
    out.real(entry.amount);
  } else {
    codec.encode(out, entry.message, {});
  }
}

bool read_override(TakeDecoder& in, InputCodec& codec, TakeOverride& entry) {
  const std::uint8_t kind = in.byte();
  if (kind > static_cast<std::uint8_t>(TakeOverride::Kind::blend)) return false;
  entry.kind = static_cast<TakeOverride::Kind>(kind);
  if (entry.kind != TakeOverride::Kind::blend) {
    InputRecord message;
    if (!codec.decode(in, message)) return false;
    entry.message = std::move(message.message);
    return true;
  }
  for (std::size_t left = in.count(); left > 0; left--) {
    PresetList single;
    if (in.failed() || !read_presets(in, single) || single.size() != 1) return false;
    entry.presets.push_back(single.front());
  }
  entry.amount = in.real();
  return entry.presets.size() == 1 || entry.presets.size() == 2;
}

bool read_runs(TakeDecoder& in, std::vector<TakeSceneRun>& runs) {
  for (std::size_t left = in.count(); left > 0 && !in.failed(); left--) {
    TakeSceneRun run;
    const std::uint8_t kind = in.byte();
    if (kind > static_cast<std::uint8_t>(TakeSceneRun::Kind::scene)) return false;
    run.kind = static_cast<TakeSceneRun::Kind>(kind);
    const std::uint8_t flags = in.byte();
    run.succeeded = (flags & 1u) != 0;
    run.reuses_files = (flags & 2u) != 0;
    run.files = static_cast<std::uint32_t>(in.varint());
    run.scene = in.string();
    runs.push_back(std::move(run));
  }
  return true;
}

// Overwrites the elements of `messages` in place, to reuse their memory.
bool read_messages(TakeDecoder& in, InputCodec& codec, bool present, std::vector<InputRecord>& messages) {
  const std::size_t count = present ? in.count() : 0;
  for (std::size_t i = 0; i < count; i++) {
    if (i == messages.size()) messages.emplace_back();
    InputRecord& message = messages[i];
    if (!codec.decode(in, message)) return false;
    // an empty address marks console input, with the Lua code as its only argument
    message.evaluate = message.message.address.empty() && message.message.args.size() == 1;
    if (!message.evaluate) continue;
    message.message.address = std::move(message.message.args[0].text);
    message.message.args.clear();
  }
  messages.resize(count);
  return true;
}

// flags of a tick: the parts that follow; most ticks have none
constexpr std::uint8_t kRunning = 1, kRuns = 2, kMessages = 4, kStopped = 8, kState = 16, kBodies = 32;

}  // namespace

Message message_of(const TakeEvent& event) {
  return {"", {Arg::of(static_cast<double>(event.kind)), Arg::of(static_cast<double>(event.value))}};
}

std::optional<TakeEvent> event_of(const Message& message) {
  if (!message.address.empty() || message.args.size() != 2) return std::nullopt;
  if (!message.args[0].is_numeric() || !message.args[1].is_numeric()) return std::nullopt;
  const double value = message.args[1].number;
  if (!(value >= 0 && value <= 1e9)) return std::nullopt;
  for (const auto kind : {TakeEvent::Kind::panic_settled, TakeEvent::Kind::messages_handled}) {
    if (message.args[0].number == static_cast<double>(kind)) return TakeEvent{kind, static_cast<std::uint64_t>(value)};
  }
  return std::nullopt;
}

std::string header_text(const TakeHeader& header) {
  const nlohmann::ordered_json json = {{"version", header.version},
                                       {"limber", header.limber},
                                       {"scene", header.scene},
                                       {"recorded", header.recorded},
                                       {"rules", header.rules}};
  using Json = nlohmann::ordered_json;
  return fmt::format("{}{}\n{}\n", kTakeMagic, header.version,
                     json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Result<TakeHeader> header_of(std::string_view first_line, std::string_view second_line) {
  const std::string_view head = kTakeMagic;
  if (!first_line.starts_with(head)) return Error{"this is not a take of Limber"};
  const auto version = parse_number(first_line.substr(head.size()));
  if (!version || !(*version >= 1)) return Error{"this is not a take of Limber"};
  if (*version > kTakeVersion) {
    return Error{
        fmt::format("this take has version {}, of a newer Limber; this one reads up to {}", *version, kTakeVersion)};
  }
  const auto json = nlohmann::json::parse(second_line, nullptr, false);
  if (!json.is_object()) return Error{"the take's second line is damaged"};
  TakeHeader header;
  const auto text = [&](const char* key) {
    const auto at = json.find(key);
    return at != json.end() && at->is_string() ? at->get<std::string>() : std::string();
  };
  header.version = static_cast<int>(*version);
  header.limber = text("limber");
  header.scene = text("scene");
  header.recorded = text("recorded");
  const auto rules = json.find("rules");
  header.rules = rules != json.end() && rules->is_number_integer() ? rules->get<int>() : 0;
  return header;
}

std::string text_of(const TakeInitialState& initial_state) {
  std::string text;
  TakeEncoder out(text);
  InputCodec codec;
  out.byte(initial_state.reset ? 1 : 0);
  out.string(initial_state.scene);
  out.byte(initial_state.seed ? 1 : 0);
  out.fixed_int(initial_state.seed.value_or(0), 8);
  out.varint(initial_state.package_paths.size());
  for (const std::string& path : initial_state.package_paths) out.string(path);
  out.string(initial_state.preset);
  out.varint(initial_state.sets.size());
  for (const Message& set : initial_state.sets) codec.encode(out, set, {});
  out.fixed_int(initial_state.world_seed, 8);
  out.fixed_int(initial_state.scene_seed, 8);
  out.byte(initial_state.paused ? 1 : 0);
  out.real(initial_state.speed);
  out.string(initial_state.preset_file);
  out.string(text_of(initial_state.presets));
  out.varint(initial_state.overrides.size());
  for (const TakeOverride& step : initial_state.overrides) write_override(out, codec, step);
  if (!initial_state.recovered.empty()) out.string(text_of(initial_state.recovered));
  return text;
}

bool read_initial_state(std::string_view bytes, TakeInitialState& state) {
  TakeDecoder in(bytes);
  InputCodec codec;
  state.reset = in.byte() != 0;
  state.scene = in.string();
  const bool seeded = in.byte() != 0;
  if (const std::uint64_t seed = in.fixed_int(8); seeded) state.seed = seed;
  for (std::size_t left = in.count(); left > 0 && !in.failed(); left--) state.package_paths.emplace_back(in.string());
  state.preset = in.string();
  for (std::size_t left = in.count(); left > 0; left--) {
    InputRecord set;
    if (!codec.decode(in, set)) return false;
    state.sets.push_back(std::move(set.message));
  }
  state.world_seed = in.fixed_int(8);
  state.scene_seed = in.fixed_int(8);
  state.paused = in.byte() != 0;
  state.speed = in.real();
  state.preset_file = in.string();
  if (in.failed() || !read_presets(in, state.presets)) return false;
  for (std::size_t left = in.count(); left > 0; left--) {
    if (!read_override(in, codec, state.overrides.emplace_back())) return false;
  }
  return in.at_end() || (!in.failed() && read_presets(in, state.recovered) && in.at_end());
}

void InputLog::record(const Message& message, const CommandOrigin& origin, bool evaluate) {
  TakeEncoder out(messages_);
  count_++;
  if (!evaluate) return codec_.encode(out, message, origin);
  console_message_.args.resize(1);
  console_message_.args[0].kind = Arg::Kind::text;
  console_message_.args[0].text = message.address;
  codec_.encode(out, console_message_, origin);
}

void InputLog::clear() {
  messages_.clear();
  count_ = 0;
}

void InputLog::append_pass(std::string& text, const RecordedPass& pass) {
  TakeEncoder out(text);
  const auto flag = [](bool present, std::uint8_t bit) { return present ? bit : std::uint8_t{0}; };
  out.byte(static_cast<std::uint8_t>(flag(pass.running, kRunning) | flag(!pass.runs.empty(), kRuns) |
                                     flag(count_ > 0, kMessages) | flag(!pass.stopped_calls.empty(), kStopped) |
                                     flag(pass.state_hash.has_value(), kState) |
                                     flag(!pass.body_hashes.empty(), kBodies)));
  if (!pass.runs.empty()) {
    out.varint(pass.runs.size());
    for (const TakeSceneRun& run : pass.runs) {
      out.byte(static_cast<std::uint8_t>(run.kind));
      out.byte(static_cast<std::uint8_t>((run.succeeded ? 1u : 0u) | (run.reuses_files ? 2u : 0u)));
      out.varint(run.files);
      out.string(run.scene);
    }
  }
  if (count_ > 0) {
    out.varint(count_);
    text.append(messages_);
  }
  if (!pass.stopped_calls.empty()) {
    out.varint(pass.stopped_calls.size());
    for (const script::StoppedCall& stop : pass.stopped_calls) {
      out.varint(stop.number);
      out.string(stop.file);
      out.varint(static_cast<std::uint64_t>(stop.line));
      out.string(stop.text);
    }
  }
  out.varint(pass.tick);
  out.fixed_int(pass.motion_hash, 8);
  if (pass.state_hash) out.fixed_int(*pass.state_hash, 8);
  clear();
  if (pass.body_hashes.empty()) return;
  out.varint(pass.first_body);
  out.varint(pass.body_hashes.size());
  for (const std::uint16_t body : pass.body_hashes) out.fixed_int(body, 2);
}

bool advances_time(std::uint8_t first_byte) { return (first_byte & kRunning) != 0; }

bool read_pass(std::string_view bytes, InputCodec& codec, RecordedPass& pass) {
  TakeDecoder in(bytes);
  const std::uint8_t parts = in.byte();
  pass.running = (parts & kRunning) != 0;
  pass.runs.clear();
  if ((parts & kRuns) != 0 && !read_runs(in, pass.runs)) return false;
  if (!read_messages(in, codec, (parts & kMessages) != 0, pass.messages)) return false;
  pass.stopped_calls.clear();
  for (std::size_t left = (parts & kStopped) != 0 ? in.count() : 0; left > 0 && !in.failed(); left--) {
    script::StoppedCall stop;
    stop.number = in.varint();
    stop.file = in.string();
    stop.line = static_cast<int>(in.varint() & 0x7fffffffu);
    stop.text = in.string();
    pass.stopped_calls.push_back(std::move(stop));
  }
  pass.tick = in.varint();
  pass.motion_hash = in.fixed_int(8);
  pass.state_hash.reset();
  if ((parts & kState) != 0) pass.state_hash = in.fixed_int(8);
  pass.first_body = 0;
  pass.body_hashes.clear();
  if ((parts & kBodies) != 0) {
    pass.first_body = static_cast<std::uint32_t>(in.varint());
    for (std::size_t left = in.count(); left > 0 && !in.failed(); left--)
      pass.body_hashes.push_back(static_cast<std::uint16_t>(in.fixed_int(2)));
  }
  return in.at_end();
}

std::string text_of(const TakeEnd& end) {
  std::string text;
  TakeEncoder out(text);
  out.varint(end.tick);
  out.fixed_int(end.state_hash, 8);
  return text;
}

bool read_end(std::string_view bytes, TakeEnd& end) {
  TakeDecoder in(bytes);
  end.tick = in.varint();
  end.state_hash = in.fixed_int(8);
  return in.at_end();
}

std::string text_of(const TakeFileList& list) {
  std::string text;
  TakeEncoder out(text);
  write_map(out, list.found);
  write_map(out, list.meshes);
  out.varint(list.files.size());
  for (const auto& [path, content] : list.files) {
    out.string(path);
    out.varint(content);
  }
  out.byte(list.has_presets ? 1 : 0);
  out.string(list.preset_file);
  out.string(list.presets);
  return text;
}

bool read_files(std::string_view bytes, TakeFileList& list) {
  TakeDecoder in(bytes);
  read_map(in, list.found);
  read_map(in, list.meshes);
  for (std::size_t left = in.count(); left > 0 && !in.failed(); left--) {
    std::string path(in.string());
    const std::uint64_t content = in.varint();
    list.files.emplace_back(std::move(path), static_cast<std::uint32_t>(content));
  }
  list.has_presets = in.byte() != 0;
  list.preset_file = in.string();
  list.presets = in.string();
  return in.at_end();
}

}  // namespace limber::engine
