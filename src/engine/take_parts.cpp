// The larger parts of a take in bytes: how it begins, ticks, lists of files, its end.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "engine/preset_text.h"
#include "engine/take_text.h"

namespace limber {

namespace {

void write_map(TakeBytes& out, const std::map<std::string, std::string>& map) {
  out.number(map.size());
  for (const auto& [key, value] : map) {
    out.text(key);
    out.text(value);
  }
}

void read_map(TakeScan& in, std::map<std::string, std::string>& map) {
  for (std::size_t left = in.count(); left > 0 && !in.bad(); left--) {
    const std::string key(in.text());
    map[key] = in.text();
  }
}

bool read_presets(TakeScan& in, PresetList& list) {
  Result<PresetsRead> read = presets_of(in.text());
  if (!read || !read->problems.empty()) return false;
  list = std::move(read->presets);
  return true;
}

void write_hand(TakeBytes& out, TakeForms& forms, const TakeHand& step) {
  out.byte(static_cast<std::uint8_t>(step.kind));
  if (step.kind == TakeHand::Kind::blend) {
    // one preset a text: two of a name would not stand in one
    out.number(step.presets.size());
    for (const auto& preset : step.presets) out.text(text_of(PresetList{preset}));
    out.real(step.amount);
  } else {
    forms.write(out, step.message, {});
  }
}

bool read_hand(TakeScan& in, TakeForms& forms, TakeHand& step) {
  const std::uint8_t kind = in.byte();
  if (kind > static_cast<std::uint8_t>(TakeHand::Kind::blend)) return false;
  step.kind = static_cast<TakeHand::Kind>(kind);
  if (step.kind != TakeHand::Kind::blend) {
    TakeMessage message;
    if (!forms.read(in, message)) return false;
    step.message = std::move(message.message);
    return true;
  }
  for (std::size_t left = in.count(); left > 0; left--) {
    PresetList one;
    if (in.bad() || !read_presets(in, one) || one.size() != 1) return false;
    step.presets.push_back(one.front());
  }
  step.amount = in.real();
  return step.presets.size() == 1 || step.presets.size() == 2;
}

bool read_runs(TakeScan& in, std::vector<TakeRun>& runs) {
  for (std::size_t left = in.count(); left > 0 && !in.bad(); left--) {
    TakeRun run;
    const std::uint8_t kind = in.byte();
    if (kind > static_cast<std::uint8_t>(TakeRun::Kind::scene)) return false;
    run.kind = static_cast<TakeRun::Kind>(kind);
    const std::uint8_t flags = in.byte();
    run.good = (flags & 1u) != 0;
    run.again = (flags & 2u) != 0;
    run.files = static_cast<std::uint32_t>(in.number());
    run.scene = in.text();
    runs.push_back(std::move(run));
  }
  return true;
}

// over those that are in the list, and their memory
bool read_messages(TakeScan& in, TakeForms& forms, bool there, std::vector<TakeMessage>& messages) {
  const std::size_t count = there ? in.count() : 0;
  for (std::size_t i = 0; i < count; i++) {
    if (i == messages.size()) messages.emplace_back();
    TakeMessage& message = messages[i];
    if (!forms.read(in, message)) return false;
    // no message has an empty address: a text of a console comes as its one argument
    message.evaluate = message.message.address.empty() && message.message.args.size() == 1;
    if (!message.evaluate) continue;
    message.message.address = std::move(message.message.args[0].text);
    message.message.args.clear();
  }
  messages.resize(count);
  return true;
}

// which parts of a tick follow: most have none
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
  for (const auto kind : {TakeEvent::Kind::panic_settled, TakeEvent::Kind::heard}) {
    if (message.args[0].number == static_cast<double>(kind)) return TakeEvent{kind, static_cast<std::uint64_t>(value)};
  }
  return std::nullopt;
}

std::string head_text(const TakeHeader& header) {
  const nlohmann::ordered_json json = {{"version", header.version},
                                       {"limber", header.limber},
                                       {"scene", header.scene},
                                       {"recorded", header.recorded},
                                       {"rules", header.rules}};
  using Json = nlohmann::ordered_json;
  return fmt::format("{}{}\n{}\n", kTakeHead, header.version,
                     json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Result<TakeHeader> header_of(std::string_view first_line, std::string_view second_line) {
  const std::string_view head = kTakeHead;
  if (!first_line.starts_with(head)) return Error{"this is no take of Limber"};
  const auto version = parse_number(first_line.substr(head.size()));
  if (!version || !(*version >= 1)) return Error{"this is no take of Limber"};
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

std::string text_of(const TakeBegin& begin) {
  std::string text;
  TakeBytes out(text);
  TakeForms forms;
  out.byte(begin.reset ? 1 : 0);
  out.text(begin.scene);
  out.byte(begin.seed ? 1 : 0);
  out.word(begin.seed.value_or(0), 8);
  out.number(begin.package_paths.size());
  for (const std::string& path : begin.package_paths) out.text(path);
  out.text(begin.preset);
  out.number(begin.sets.size());
  for (const Message& set : begin.sets) forms.write(out, set, {});
  out.word(begin.world_seed, 8);
  out.word(begin.scene_seed, 8);
  out.byte(begin.paused ? 1 : 0);
  out.real(begin.speed);
  out.text(begin.preset_file);
  out.text(text_of(begin.presets));
  out.number(begin.hand.size());
  for (const TakeHand& step : begin.hand) write_hand(out, forms, step);
  if (!begin.recovered.empty()) out.text(text_of(begin.recovered));
  return text;
}

bool read_begin(std::string_view bytes, TakeBegin& begin) {
  TakeScan in(bytes);
  TakeForms forms;
  begin.reset = in.byte() != 0;
  begin.scene = in.text();
  const bool seeded = in.byte() != 0;
  if (const std::uint64_t seed = in.word(8); seeded) begin.seed = seed;
  for (std::size_t left = in.count(); left > 0 && !in.bad(); left--) begin.package_paths.emplace_back(in.text());
  begin.preset = in.text();
  for (std::size_t left = in.count(); left > 0; left--) {
    TakeMessage set;
    if (!forms.read(in, set)) return false;
    begin.sets.push_back(std::move(set.message));
  }
  begin.world_seed = in.word(8);
  begin.scene_seed = in.word(8);
  begin.paused = in.byte() != 0;
  begin.speed = in.real();
  begin.preset_file = in.text();
  if (in.bad() || !read_presets(in, begin.presets)) return false;
  for (std::size_t left = in.count(); left > 0; left--) {
    if (!read_hand(in, forms, begin.hand.emplace_back())) return false;
  }
  return in.done() || (!in.bad() && read_presets(in, begin.recovered) && in.done());
}

void append_tick(std::string& text, const TakeTick& tick, std::size_t message_count, std::string_view messages) {
  TakeBytes out(text);
  const auto flag = [](bool there, std::uint8_t bit) { return there ? bit : std::uint8_t{0}; };
  out.byte(static_cast<std::uint8_t>(flag(tick.running, kRunning) | flag(!tick.runs.empty(), kRuns) |
                                     flag(message_count > 0, kMessages) | flag(!tick.stopped.empty(), kStopped) |
                                     flag(tick.state.has_value(), kState) | flag(!tick.bodies.empty(), kBodies)));
  if (!tick.runs.empty()) {
    out.number(tick.runs.size());
    for (const TakeRun& run : tick.runs) {
      out.byte(static_cast<std::uint8_t>(run.kind));
      out.byte(static_cast<std::uint8_t>((run.good ? 1u : 0u) | (run.again ? 2u : 0u)));
      out.number(run.files);
      out.text(run.scene);
    }
  }
  if (message_count > 0) {
    out.number(message_count);
    text.append(messages);
  }
  if (!tick.stopped.empty()) {
    out.number(tick.stopped.size());
    for (const StoppedCall& stop : tick.stopped) {
      out.number(stop.number);
      out.text(stop.file);
      out.number(static_cast<std::uint64_t>(stop.line));
      out.text(stop.text);
    }
  }
  out.number(tick.tick);
  out.word(tick.motion, 8);
  if (tick.state) out.word(*tick.state, 8);
  if (tick.bodies.empty()) return;
  out.number(tick.first_body);
  out.number(tick.bodies.size());
  for (const std::uint16_t body : tick.bodies) out.word(body, 2);
}

bool tick_runs(std::uint8_t first_byte) { return (first_byte & kRunning) != 0; }

bool read_tick(std::string_view bytes, TakeForms& forms, TakeTick& tick) {
  TakeScan in(bytes);
  const std::uint8_t parts = in.byte();
  tick.running = (parts & kRunning) != 0;
  tick.runs.clear();
  if ((parts & kRuns) != 0 && !read_runs(in, tick.runs)) return false;
  if (!read_messages(in, forms, (parts & kMessages) != 0, tick.messages)) return false;
  tick.stopped.clear();
  for (std::size_t left = (parts & kStopped) != 0 ? in.count() : 0; left > 0 && !in.bad(); left--) {
    StoppedCall stop;
    stop.number = in.number();
    stop.file = in.text();
    stop.line = static_cast<int>(in.number() & 0x7fffffffu);
    stop.text = in.text();
    tick.stopped.push_back(std::move(stop));
  }
  tick.tick = in.number();
  tick.motion = in.word(8);
  tick.state.reset();
  if ((parts & kState) != 0) tick.state = in.word(8);
  tick.first_body = 0;
  tick.bodies.clear();
  if ((parts & kBodies) != 0) {
    tick.first_body = static_cast<std::uint32_t>(in.number());
    for (std::size_t left = in.count(); left > 0 && !in.bad(); left--)
      tick.bodies.push_back(static_cast<std::uint16_t>(in.word(2)));
  }
  return in.done();
}

std::string text_of(const TakeEnd& end) {
  std::string text;
  TakeBytes out(text);
  out.number(end.tick);
  out.word(end.state, 8);
  return text;
}

bool read_end(std::string_view bytes, TakeEnd& end) {
  TakeScan in(bytes);
  end.tick = in.number();
  end.state = in.word(8);
  return in.done();
}

std::string text_of(const TakeFileList& list) {
  std::string text;
  TakeBytes out(text);
  write_map(out, list.found);
  write_map(out, list.meshes);
  out.number(list.files.size());
  for (const auto& [path, content] : list.files) {
    out.text(path);
    out.number(content);
  }
  out.byte(list.has_presets ? 1 : 0);
  out.text(list.preset_file);
  out.text(list.presets);
  return text;
}

bool read_files(std::string_view bytes, TakeFileList& list) {
  TakeScan in(bytes);
  read_map(in, list.found);
  read_map(in, list.meshes);
  for (std::size_t left = in.count(); left > 0 && !in.bad(); left--) {
    std::string path(in.text());
    const std::uint64_t content = in.number();
    list.files.emplace_back(std::move(path), static_cast<std::uint32_t>(content));
  }
  list.has_presets = in.byte() != 0;
  list.preset_file = in.text();
  list.presets = in.text();
  return in.done();
}

}  // namespace limber
