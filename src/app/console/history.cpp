// Reads and writes the history file.
#include "app/console/history.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/paths.h"
#include "base/system/file.h"
#include "base/text.h"

namespace limber::app {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMaxFileBytes = 4u << 20;  // bytes; of a larger file only the last part is read

bool is_storable(std::string_view line) {
  return !line.empty() && line.size() <= ConsoleHistory::kMaxLineBytes && printable(line) == line &&
         line.find('\n') == std::string_view::npos && line.find_first_not_of(" \t") != std::string_view::npos;
}

}  // namespace

std::string ConsoleHistory::default_file() {
  const std::string folder = state_dir();
  return folder.empty() ? "" : folder + "/console_history";
}

ConsoleHistory::ConsoleHistory(std::string file) : file_(std::move(file)) {
  std::error_code error;
  if (file_.empty() || !fs::is_regular_file(file_, error)) return;
  std::ifstream in(file_, std::ios::binary);
  if (const std::uintmax_t size = fs::file_size(file_, error); !error && size > kMaxFileBytes)
    in.seekg(-static_cast<std::streamoff>(kMaxFileBytes), std::ios::end);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::size_t line_count = 0;
  for (const std::string_view line : split(text, '\n')) {
    line_count += line.empty() ? 0 : 1;
    if (is_storable(line)) lines_.emplace_back(line);
  }
  if (lines_.size() > kMaxLines) lines_.erase(lines_.begin(), lines_.end() - kMaxLines);
  if (line_count > lines_.size() + kMaxLines / 4 || text.size() == kMaxFileBytes) rewrite();
}

void ConsoleHistory::add(std::string_view line) {
  if (!is_storable(line) || (!lines_.empty() && lines_.back() == line)) return;
  lines_.emplace_back(line);
  if (lines_.size() > kMaxLines) lines_.erase(lines_.begin());
  if (file_.empty()) return;
  std::error_code ignored;
  fs::create_directories(fs::path(file_).parent_path(), ignored);
  const system::Descriptor file = system::open_file(file_, system::OpenMode::append_any, 0600);
  // one write: lines of several consoles don't mix
  if (file.is_open()) system::write_all(file.fd(), std::string(line) + "\n");
}

// rewrites the file without old or unprintable lines; the old file stays until the new one is complete
void ConsoleHistory::rewrite() const {
  const std::string temporary = file_ + ".new";
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  bool complete = false;
  {
    const system::Descriptor file = system::open_file(temporary, system::OpenMode::replace, 0600);
    complete = file.is_open() && system::write_all(file.fd(), text);
  }
  if (!complete || std::rename(temporary.c_str(), file_.c_str()) != 0) std::remove(temporary.c_str());
}

}  // namespace limber::app
