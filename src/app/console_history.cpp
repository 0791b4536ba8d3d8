// The history's file.
#include "app/console_history.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/paths.h"
#include "base/system/file.h"
#include "base/text.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMostFile = 4u << 20;  // a file that has grown beyond this is read from so far before its end

bool worth_keeping(std::string_view line) {
  return !line.empty() && line.size() <= ConsoleHistory::kMostBytes && printable(line) == line &&
         line.find('\n') == std::string_view::npos && line.find_first_not_of(" \t") != std::string_view::npos;
}

}  // namespace

std::string ConsoleHistory::default_file() {
  const std::string folder = state_dir();
  return folder.empty() ? "" : folder + "/console_history";
}

ConsoleHistory::ConsoleHistory(std::string file) : file_(std::move(file)) {
  std::error_code fault;
  if (file_.empty() || !fs::is_regular_file(file_, fault)) return;
  std::ifstream in(file_, std::ios::binary);
  if (const std::uintmax_t size = fs::file_size(file_, fault); !fault && size > kMostFile)
    in.seekg(-static_cast<std::streamoff>(kMostFile), std::ios::end);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::size_t seen = 0;
  for (const std::string_view line : split(text, '\n')) {
    seen += line.empty() ? 0 : 1;
    if (worth_keeping(line)) lines_.emplace_back(line);
  }
  if (lines_.size() > kMostLines) lines_.erase(lines_.begin(), lines_.end() - kMostLines);
  if (seen > lines_.size() + kMostLines / 4 || text.size() == kMostFile) rewrite();
}

void ConsoleHistory::add(std::string_view line) {
  if (!worth_keeping(line) || (!lines_.empty() && lines_.back() == line)) return;
  lines_.emplace_back(line);
  if (lines_.size() > kMostLines) lines_.erase(lines_.begin());
  if (file_.empty()) return;
  std::error_code ignored;
  fs::create_directories(fs::path(file_).parent_path(), ignored);
  const system::Descriptor file = system::open_file(file_, system::OpenMode::append_any, 0600);
  // one write: lines of several consoles don't mix
  if (file.open()) system::write_all(file.fd(), std::string(line) + "\n");
}

// the file anew, without what is too old or no text; the old one stays until the new one is whole
void ConsoleHistory::rewrite() const {
  const std::string fresh = file_ + ".new";
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  bool whole = false;
  {
    const system::Descriptor file = system::open_file(fresh, system::OpenMode::replace, 0600);
    whole = file.open() && system::write_all(file.fd(), text);
  }
  if (!whole || std::rename(fresh.c_str(), file_.c_str()) != 0) std::remove(fresh.c_str());
}

}  // namespace limber
