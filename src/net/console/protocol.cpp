// JSON with bounded nesting: a line that nests deeper is rejected while it is parsed.
#include "net/console/protocol.h"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/text.h"

namespace limber::console {

namespace {

using Json = nlohmann::json;
using Kind = ConsoleLine::Kind;

// the member that identifies the kind of a line
constexpr std::array<std::pair<const char*, Kind>, 14> kKindKeys = {{{"limber", Kind::hello},
                                                                     {"done", Kind::done},
                                                                     {"value", Kind::value},
                                                                     {"error", Kind::error},
                                                                     {"incomplete", Kind::incomplete},
                                                                     {"names", Kind::names},
                                                                     {"print", Kind::print},
                                                                     {"warning", Kind::warning},
                                                                     {"fault", Kind::fault},
                                                                     {"missed", Kind::missed},
                                                                     {"refused", Kind::rejected},
                                                                     {"in", Kind::in},
                                                                     {"out", Kind::out},
                                                                     {"change", Kind::change}}};

const char* key_of(Kind kind) {
  for (const auto& [word, each] : kKindKeys) {
    if (each == kind) return word;
  }
  return "done";
}

std::string text_of(const Json& line) { return line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

// parses an object with at most `max_depth` further levels; discarded if invalid
Json parse_object(std::string_view line, int max_depth) {
  const auto within_depth = [max_depth](int depth, Json::parse_event_t event, Json&) {
    const bool opens = event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    return !opens || depth <= max_depth;
  };
  Json json = Json::parse(line.begin(), line.end(), within_depth, false);
  return json.is_object() ? json : Json(Json::value_t::discarded);
}

std::string text_member(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_string() ? at->get<std::string>() : std::string();
}

std::uint64_t number_member(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number_unsigned() ? at->get<std::uint64_t>() : 0;
}

}  // namespace

std::string request_line(const ConsoleRequest& request) {
  using RequestKind = ConsoleRequest::Kind;
  if (request.kind == RequestKind::evaluate) return text_of({{"id", request.id}, {"evaluate", request.text}});
  if (request.kind == RequestKind::complete) return text_of({{"id", request.id}, {"complete", request.text}});
  const char* const stream = request.kind == RequestKind::traffic ? "traffic" : "changes";
  return text_of({{"id", request.id}, {"watch", stream}, {"of", request.text}});
}

std::string hello_line(std::string_view version, int pid, std::string_view scene) {
  return text_of({{"limber", version}, {"pid", pid}, {"scene", printable(scene)}});
}

std::string result_line(std::uint64_t id, const Evaluation& result) {
  Json line{{"id", id}};
  switch (result.kind) {
    case Evaluation::Kind::done:
      line["done"] = true;
      break;
    case Evaluation::Kind::value:
      line["value"] = printable(result.text);
      break;
    case Evaluation::Kind::error:
      line["error"] = printable(result.text);
      break;
    case Evaluation::Kind::incomplete:
      line["incomplete"] = true;
      break;
    case Evaluation::Kind::names: {
      Json names = Json::array();
      for (const std::string_view name : split(result.text, '\n')) {
        if (!name.empty()) names.push_back(printable(name));
      }
      line["names"] = std::move(names);
      line["word"] = result.word;
      break;
    }
  }
  return text_of(line);
}

std::string log_line(std::uint64_t id, const LogLine& line) {
  const Kind kind = line.level == LogLevel::print     ? Kind::print
                    : line.level == LogLevel::warning ? Kind::warning
                                                      : Kind::fault;
  Json json{{key_of(kind), line.text}};
  if (id != 0) json["id"] = id;
  return text_of(json);
}

std::string traffic_line(bool in, double time, std::string_view peer, std::string_view text) {
  return text_of({{in ? "in" : "out", text}, {"time", time}, {"end", peer}});
}

std::string change_line(double time, std::string_view source, std::string_view text) {
  return text_of({{"change", text}, {"time", time}, {"end", source}});
}

std::string missed_line(std::uint64_t count) { return text_of({{"missed", count}}); }

std::string rejected_line(std::string_view reason) { return text_of({{"refused", printable(reason)}}); }

Result<ConsoleRequest> parse_request(std::string_view line) {
  const Json json = parse_object(line, 0);
  if (json.is_discarded()) {
    return Error{"not a request; expected a line of JSON such as {\"id\":1,\"evaluate\":\"sim.time\"}"};
  }
  using RequestKind = ConsoleRequest::Kind;
  ConsoleRequest request;
  request.id = number_member(json, "id");
  if (json.contains("watch")) {
    const std::string stream = text_member(json, "watch");
    if (stream != "traffic" && stream != "changes") return Error{"\"watch\" must be \"traffic\" or \"changes\""};
    request.kind = stream == "traffic" ? RequestKind::traffic : RequestKind::changes;
    request.text = text_member(json, "of");
    return request;
  }
  request.kind = json.contains("complete") ? RequestKind::complete : RequestKind::evaluate;
  const char* key = request.kind == RequestKind::complete ? "complete" : "evaluate";
  if (!json.contains(key) || !json[key].is_string())
    return Error{"a request must have a text in \"evaluate\" or \"complete\""};
  request.text = text_member(json, key);
  return request;
}

Result<ConsoleLine> parse_line(std::string_view text) {
  const Json json = parse_object(text, 1);
  if (json.is_discarded()) return Error{"the program does not use the console protocol"};
  ConsoleLine line;
  const char* key = nullptr;
  for (const auto& [word, kind] : kKindKeys) {
    if (key != nullptr || !json.contains(word)) continue;
    key = word;
    line.kind = kind;
  }
  if (key == nullptr) return Error{"unknown line from the program"};
  line.id = number_member(json, "id");
  line.text = text_member(json, line.kind == Kind::hello ? "scene" : key);
  line.word = number_member(json, "word");
  line.count = number_member(json, "missed");
  line.version = text_member(json, "limber");
  line.pid = static_cast<int>(number_member(json, "pid"));
  line.origin = text_member(json, "end");
  if (json.contains("time") && json["time"].is_number()) line.time = json["time"].get<double>();
  if (line.kind == Kind::names && json["names"].is_array()) {
    for (const Json& name : json["names"]) {
      if (name.is_string()) line.names.push_back(name.get<std::string>());
    }
  }
  return line;
}

}  // namespace limber::console
