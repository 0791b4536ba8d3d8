// ChangeLog: a bounded queue under a mutex, held for the time of a copy or a search.
#include "engine/edits/change_log.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace limber::engine {

std::uint64_t ChangeLog::add(ChangeEntry entry) {
  const std::scoped_lock lock(mutex_);
  entry.number = ++newest_;
  entry.version = ++versions_;
  entries_.push_back(std::move(entry));
  if (entries_.size() > kMaxEntries) entries_.pop_front();
  return newest_;
}

bool ChangeLog::update(std::uint64_t number, double time, std::string to) {
  const std::scoped_lock lock(mutex_);
  if (entries_.empty() || number < entries_.front().number) return false;
  ChangeEntry& entry = entries_[number - entries_.front().number];
  entry.version = ++versions_;
  entry.time = time;
  entry.to = std::move(to);
  return true;
}

std::vector<ChangeEntry> ChangeLog::after(std::uint64_t version) const {
  std::vector<ChangeEntry> entries;
  {
    const std::scoped_lock lock(mutex_);
    std::ranges::copy_if(entries_, std::back_inserter(entries),
                         [&](const ChangeEntry& entry) { return entry.version > version; });
  }
  std::ranges::sort(entries, {}, &ChangeEntry::version);
  return entries;
}

std::vector<ChangeEntry> ChangeLog::since(double time) const {
  std::vector<ChangeEntry> entries;
  const std::scoped_lock lock(mutex_);
  std::ranges::copy_if(entries_, std::back_inserter(entries),
                       [&](const ChangeEntry& entry) { return entry.time >= time; });
  return entries;
}

}  // namespace limber::engine
