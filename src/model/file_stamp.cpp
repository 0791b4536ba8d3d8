// Asking the file system first, the content where that does not settle it.
#include "model/file_stamp.h"

#include <sys/stat.h>

#include <array>
#include <ctime>
#include <fstream>

#include "base/hash.h"

namespace limber {

namespace {

// file systems' clocks tick every few milliseconds: two saves between two ticks have one time
constexpr std::int64_t kYoung = 100'000'000;

std::int64_t nanoseconds(const timespec& t) { return t.tv_sec * 1'000'000'000LL + t.tv_nsec; }

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
  struct stat info {};
  if (stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return false;
  out = {static_cast<std::uintmax_t>(info.st_size), info.st_ino, nanoseconds(info.st_mtim), nanoseconds(info.st_ctim)};
  return true;
}

FileStamp::FileStamp(const std::string& path) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  // asked before it is read: a change in between is seen the next time
  readable_ = ask(path, outside_) && hash_file(path, content_);
  if (!readable_) content_ = 0;
  settled_ = readable_ && nanoseconds(now) - outside_.changed > kYoung;
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
