// Commands are untrusted JSON, so the type of each member is checked.
#include "net/oscquery/client.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "base/log/log.h"
#include "net/oscquery/attributes.h"

namespace limber::oscquery {

namespace {

constexpr std::size_t kLogLines = 100;  // maximum number per frame

std::string_view level_name(LogLevel level) {
  return level == LogLevel::error ? "error" : level == LogLevel::warning ? "warning" : "info";
}

}  // namespace

QueryClient::QueryClient(const CommandOrigin& origin, ClientSink& sink, const QueryHost& host)
    : origin_(origin), sink_(sink), host_(host) {}

bool QueryClient::on_text(std::string_view frame) {
  const nlohmann::json json = nlohmann::json::parse(frame, nullptr, false);
  if (!json.is_object()) return false;
  const auto command = json.find("COMMAND");
  const auto data = json.find("DATA");
  if (command == json.end() || !command->is_string() || data == json.end()) return false;
  const std::string& name = command->get_ref<const std::string&>();
  if (name == "LIMBER_LOG" && data->is_boolean()) {
    wants_log_ = data->get<bool>();
    seen_line_ = 0;
    if (wants_log_) send_log();
    return false;
  }
  if (!data->is_string()) return false;
  const std::string& path = data->get_ref<const std::string&>();
  bool needs_value = false;
  if (name == "LISTEN") needs_value = feed_.add(path);
  if (name == "IGNORE") feed_.remove(path);
  origin_.is_subscriber = is_listening();
  return needs_value;
}

void QueryClient::on_binary(std::string_view frame) { host_.process(origin_, std::string(frame)); }

void QueryClient::on_snapshot(const std::shared_ptr<const engine::ValueSnapshot>& snapshot,
                              std::span<const std::string> events) {
  for (const std::string& event : events) sink_.send(true, event);
  if (!is_listening()) return;
  feed_.update(snapshot, origin_);
  feed_.send_changes([this](const std::string& path, const Property& property, const engine::PropertyValue& value) {
    if (sink_.queued_bytes() >= kMaxQueuedForValues) return false;
    sink_.send(false, host_.encode(value_message(path, property, value), tags_of(property)));
    return true;
  });
}

void QueryClient::send_reply(const engine::Outgoing& out, double now) {
  if (out.destination == engine::Outgoing::Destination::error) {
    if (now - error_window_start_ >= 1) {
      error_window_start_ = now;
      errors_ = 0;
    }
    if (++errors_ > kMaxErrors) return;
  }
  sink_.send(false, host_.encode(out.message, ""));
}

void QueryClient::send_log() {
  if (!wants_log_ || sink_.queued_bytes() >= kMaxQueuedForValues) return;
  std::vector<LogLine> lines = log_since(seen_line_);
  if (lines.empty()) return;
  seen_line_ = lines.back().number;
  nlohmann::json data = nlohmann::json::array();
  const std::size_t first = lines.size() - std::min(lines.size(), kLogLines);
  for (std::size_t i = first; i < lines.size(); i++)
    data.push_back({{"LEVEL", level_name(lines[i].level)}, {"TEXT", std::move(lines[i].text)}});
  const nlohmann::json frame = {{"COMMAND", "LIMBER_LOG"}, {"DATA", std::move(data)}};
  sink_.send(true, frame.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace limber::oscquery
