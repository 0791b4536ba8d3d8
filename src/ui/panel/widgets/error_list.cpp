// Parses log lines for script files.
#include "ui/panel/widgets/error_list.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "base/plural.h"

namespace limber::panel {

ErrorEntry parse_error_line(const LogLine& line) {
  ErrorEntry entry{line, {}, {}};
  // "file.lua:12: message"
  const std::size_t colon = line.text.find(".lua:");
  if (colon == std::string::npos || line.text.find('\n') < colon) return entry;
  const std::size_t end = colon + 4;
  std::size_t digits = end + 1;
  while (digits < line.text.size() && std::isdigit(static_cast<unsigned char>(line.text[digits])) != 0) digits++;
  if (digits == end + 1) return entry;
  std::size_t begin = line.text.rfind(' ', colon);
  begin = begin == std::string::npos ? 0 : begin + 1;
  entry.file = line.text.substr(begin, end - begin);
  entry.location = line.text.substr(begin, digits - begin);
  return entry;
}

void ErrorList::add(const LogLine& line) {
  if (line.level == LogLevel::info && line.text.ends_with(kResolvedSuffix)) {
    const std::string file = line.text.substr(0, line.text.size() - kResolvedSuffix.size());
    std::erase_if(entries_, [&](const ErrorEntry& f) { return f.line.level == LogLevel::error && f.file == file; });
  }
  if (line.level != LogLevel::warning && line.level != LogLevel::error) return;
  if (entries_.size() >= kMaxEntries) entries_.pop_front();
  entries_.push_back(parse_error_line(line));
}

std::string ErrorList::count_text() const {
  const std::size_t warnings = entries_.size() - error_count();
  std::string text = error_count() == 0 ? "" : fmt::format("{}", error_count());
  if (warnings == 0) return text;
  return text + (text.empty() ? "" : " + ") + counted(warnings, "warning");
}

std::size_t ErrorList::error_count() const {
  return static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(),
                                                [](const ErrorEntry& f) { return f.line.level == LogLevel::error; }));
}

}  // namespace limber::panel
