// A ring of lines under a lock that is held for a copy or a search.
#include "engine/change_log.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace limber {

std::uint64_t ChangeLog::add(ChangeLine line) {
  const std::scoped_lock lock(mutex_);
  line.number = ++newest_;
  line.version = ++versions_;
  lines_.push_back(std::move(line));
  if (lines_.size() > kMostLines) lines_.pop_front();
  return newest_;
}

bool ChangeLog::renew(std::uint64_t number, double time, std::string to) {
  const std::scoped_lock lock(mutex_);
  if (lines_.empty() || number < lines_.front().number) return false;
  ChangeLine& line = lines_[number - lines_.front().number];
  line.version = ++versions_;
  line.time = time;
  line.to = std::move(to);
  return true;
}

std::vector<ChangeLine> ChangeLog::after(std::uint64_t version) const {
  std::vector<ChangeLine> lines;
  {
    const std::scoped_lock lock(mutex_);
    std::ranges::copy_if(lines_, std::back_inserter(lines),
                         [&](const ChangeLine& line) { return line.version > version; });
  }
  std::ranges::sort(lines, {}, &ChangeLine::version);
  return lines;
}

std::vector<ChangeLine> ChangeLog::since(double time) const {
  std::vector<ChangeLine> lines;
  const std::scoped_lock lock(mutex_);
  std::ranges::copy_if(lines_, std::back_inserter(lines), [&](const ChangeLine& line) { return line.time >= time; });
  return lines;
}

}  // namespace limber
