// Asking the file system first, the content where that does not settle it.
#include "model/file_stamp.h"

#include <array>
#include <fstream>
#include <optional>

#include "base/hash.h"
#include "base/system/clock.h"
#include "base/system/file.h"

namespace limber {

namespace {

// file systems' clocks tick every few milliseconds: two saves between two ticks have one time
constexpr std::int64_t kYoung = 100'000'000;

bool hash_file(const std::string& path, std::uint64_t& hash) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return false;
  std::array<char, 65536> block;
  hash = hash_bytes("");
  while (in.read(block.data(), block.size()) || in.gcount() > 0) {
    hash = hash_bytes({block.data(), static_cast<std::size_t>(in.gcount())}, hash);
  }
  return true;
}

}  // namespace

bool FileStamp::ask(const std::string& path, Outside& out) {
  const std::optional<system::FileStatus> status = system::file_status(path);
  if (!status || !status->file) return false;
  out = {status->size, status->inode, status->modified, status->changed};
  return true;
}

FileStamp::FileStamp(const std::string& path) {
  const std::int64_t now = system::file_clock_nanoseconds();
  // asked before it is read: a change in between is seen the next time
  readable_ = ask(path, outside_) && hash_file(path, content_);
  if (!readable_) content_ = 0;
  settled_ = readable_ && now - outside_.changed > kYoung;
}

bool FileStamp::holds(const std::string& path) {
  Outside now;
  if (!ask(path, now)) return !readable_;
  if (readable_ && settled_ && now == outside_) return true;
  const FileStamp anew(path);
  if (!(anew == *this)) return false;
  *this = anew;
  return true;
}

}  // namespace limber
