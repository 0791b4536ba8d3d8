// Commands are JSON of any content; nothing of it is trusted to have a shape.
#include "query/client.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "query/row_face.h"

namespace limber {

namespace {

constexpr std::size_t kLogLines = 100;  // in one frame

std::string_view level_name(LogLevel level) {
  return level == LogLevel::error ? "error" : level == LogLevel::warning ? "warning" : "info";
}

}  // namespace

Client::Client(const Origin& origin, ClientLine& line, const QueryDoors& doors)
    : origin_(origin), line_(line), doors_(doors) {}

bool Client::text(std::string_view frame) {
  const nlohmann::json json = nlohmann::json::parse(frame, nullptr, false);
  if (!json.is_object()) return false;
  const auto command = json.find("COMMAND");
  const auto data = json.find("DATA");
  if (command == json.end() || !command->is_string() || data == json.end()) return false;
  const std::string& word = command->get_ref<const std::string&>();
  if (word == "LIMBER_LOG" && data->is_boolean()) {
    wants_log_ = data->get<bool>();
    seen_line_ = 0;
    if (wants_log_) log();
    return false;
  }
  if (!data->is_string()) return false;
  const std::string& path = data->get_ref<const std::string&>();
  bool waits = false;
  if (word == "LISTEN") waits = feed_.add(path);
  if (word == "IGNORE") feed_.remove(path);
  origin_.follows = listens();
  return waits;
}

void Client::binary(std::string_view frame) { doors_.take(origin_, std::string(frame)); }

void Client::image(const std::shared_ptr<const Image>& image, std::span<const std::string> notices) {
  for (const std::string& notice : notices) line_.send(true, notice);
  if (!listens()) return;
  feed_.hear(image, origin_);
  feed_.tell([this](const std::string& path, const Row& row, const RowValue& value) {
    if (line_.waiting() >= kRoom) return false;
    line_.send(false, doors_.encode(value_message(path, row, value), tags_of(row)));
    return true;
  });
}

void Client::answer(const Outgoing& out, double now) {
  if (out.to == Outgoing::To::error) {
    if (now - errors_since_ >= 1) {
      errors_since_ = now;
      errors_ = 0;
    }
    if (++errors_ > kMostErrors) return;
  }
  line_.send(false, doors_.encode(out.message, ""));
}

void Client::log() {
  if (!wants_log_ || line_.waiting() >= kRoom) return;
  std::vector<LogLine> lines = log_since(seen_line_);
  if (lines.empty()) return;
  seen_line_ = lines.back().number;
  nlohmann::json data = nlohmann::json::array();
  const std::size_t first = lines.size() - std::min(lines.size(), kLogLines);
  for (std::size_t i = first; i < lines.size(); i++)
    data.push_back({{"LEVEL", level_name(lines[i].level)}, {"TEXT", std::move(lines[i].text)}});
  const nlohmann::json frame = {{"COMMAND", "LIMBER_LOG"}, {"DATA", std::move(data)}};
  line_.send(true, frame.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace limber
