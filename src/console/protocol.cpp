// JSON, flat and small: a line that nests is refused before it is built.
#include "console/protocol.h"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/text.h"

namespace limber {

namespace {

using Json = nlohmann::json;
using Kind = ConsoleLine::Kind;

// the member that tells what a line is
constexpr std::array<std::pair<const char*, Kind>, 14> kWords = {{{"limber", Kind::hello},
                                                                  {"done", Kind::done},
                                                                  {"value", Kind::value},
                                                                  {"error", Kind::error},
                                                                  {"incomplete", Kind::incomplete},
                                                                  {"names", Kind::names},
                                                                  {"print", Kind::print},
                                                                  {"warning", Kind::warning},
                                                                  {"fault", Kind::fault},
                                                                  {"missed", Kind::missed},
                                                                  {"refused", Kind::refused},
                                                                  {"in", Kind::in},
                                                                  {"out", Kind::out},
                                                                  {"change", Kind::change}}};

const char* word_of(Kind kind) {
  for (const auto& [word, each] : kWords) {
    if (each == kind) return word;
  }
  return "done";
}

std::string text_of(const Json& line) { return line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

// an object with plain members, in which one list may stand; else discarded
Json parse_flat(std::string_view line, int deepest) {
  const auto flat = [deepest](int depth, Json::parse_event_t event, Json&) {
    const bool opens = event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    return !opens || depth <= deepest;
  };
  Json json = Json::parse(line.begin(), line.end(), flat, false);
  return json.is_object() ? json : Json(Json::value_t::discarded);
}

std::string text_in(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_string() ? at->get<std::string>() : std::string();
}

std::uint64_t number_in(const Json& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_number_unsigned() ? at->get<std::uint64_t>() : 0;
}

}  // namespace

std::string request_line(const ConsoleRequest& request) {
  using Wish = ConsoleRequest::Wish;
  if (request.wish == Wish::evaluate) return text_of({{"id", request.id}, {"evaluate", request.text}});
  if (request.wish == Wish::complete) return text_of({{"id", request.id}, {"complete", request.text}});
  const char* const what = request.wish == Wish::traffic ? "traffic" : "changes";
  return text_of({{"id", request.id}, {"watch", what}, {"of", request.text}});
}

std::string hello_line(std::string_view version, int pid, std::string_view scene) {
  return text_of({{"limber", version}, {"pid", pid}, {"scene", printable(scene)}});
}

std::string answer_line(std::uint64_t id, const Evaluation& said) {
  Json line{{"id", id}};
  switch (said.kind) {
    case Evaluation::Kind::done:
      line["done"] = true;
      break;
    case Evaluation::Kind::value:
      line["value"] = printable(said.text);
      break;
    case Evaluation::Kind::error:
      line["error"] = printable(said.text);
      break;
    case Evaluation::Kind::incomplete:
      line["incomplete"] = true;
      break;
    case Evaluation::Kind::names: {
      Json names = Json::array();
      for (const std::string_view name : split(said.text, '\n')) {
        if (!name.empty()) names.push_back(printable(name));
      }
      line["names"] = std::move(names);
      line["word"] = said.word;
      break;
    }
  }
  return text_of(line);
}

std::string log_line(std::uint64_t id, const LogLine& line) {
  const Kind kind = line.level == LogLevel::print     ? Kind::print
                    : line.level == LogLevel::warning ? Kind::warning
                                                      : Kind::fault;
  Json json{{word_of(kind), line.text}};
  if (id != 0) json["id"] = id;
  return text_of(json);
}

std::string traffic_line(bool in, double time, std::string_view end, std::string_view text) {
  return text_of({{in ? "in" : "out", text}, {"time", time}, {"end", end}});
}

std::string change_line(double time, std::string_view who, std::string_view text) {
  return text_of({{"change", text}, {"time", time}, {"end", who}});
}

std::string missed_line(std::uint64_t count) { return text_of({{"missed", count}}); }

std::string refused_line(std::string_view why) { return text_of({{"refused", printable(why)}}); }

Result<ConsoleRequest> parse_request(std::string_view line) {
  const Json json = parse_flat(line, 0);
  if (json.is_discarded()) {
    return Error{"this is no request; one is a line of JSON such as {\"id\":1,\"evaluate\":\"sim.time\"}"};
  }
  using Wish = ConsoleRequest::Wish;
  ConsoleRequest request;
  request.id = number_in(json, "id");
  if (json.contains("watch")) {
    const std::string what = text_in(json, "watch");
    if (what != "traffic" && what != "changes") return Error{"\"watch\" is \"traffic\" or \"changes\""};
    request.wish = what == "traffic" ? Wish::traffic : Wish::changes;
    request.text = text_in(json, "of");
    return request;
  }
  request.wish = json.contains("complete") ? Wish::complete : Wish::evaluate;
  const char* key = request.wish == Wish::complete ? "complete" : "evaluate";
  if (!json.contains(key) || !json[key].is_string())
    return Error{"a request has a text in \"evaluate\" or in \"complete\""};
  request.text = text_in(json, key);
  return request;
}

Result<ConsoleLine> parse_line(std::string_view text) {
  const Json json = parse_flat(text, 1);
  if (json.is_discarded()) return Error{"the other end does not speak the console's language"};
  ConsoleLine line;
  const char* key = nullptr;
  for (const auto& [word, kind] : kWords) {
    if (key != nullptr || !json.contains(word)) continue;
    key = word;
    line.kind = kind;
  }
  if (key == nullptr) return Error{"the other end says what this console does not know"};
  line.id = number_in(json, "id");
  line.text = text_in(json, line.kind == Kind::hello ? "scene" : key);
  line.word = number_in(json, "word");
  line.count = number_in(json, "missed");
  line.version = text_in(json, "limber");
  line.pid = static_cast<int>(number_in(json, "pid"));
  line.end = text_in(json, "end");
  if (json.contains("time") && json["time"].is_number()) line.time = json["time"].get<double>();
  if (line.kind == Kind::names && json["names"].is_array()) {
    for (const Json& name : json["names"]) {
      if (name.is_string()) line.names.push_back(name.get<std::string>());
    }
  }
  return line;
}

}  // namespace limber
