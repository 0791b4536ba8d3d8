// Change detection by file status, with a content hash where the status is not conclusive.
#include "model/file_stamp.h"

#include <array>
#include <fstream>
#include <optional>

#include "base/hash.h"
#include "base/system/clock.h"
#include "base/system/file.h"

namespace limber::model {

namespace {

// ns. File system clocks tick every few milliseconds, so two saves within one tick get the same time.
constexpr std::int64_t kTimeResolution = 100'000'000;

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

bool FileStamp::query_status(const std::string& path, FileStatus& out) {
  const std::optional<system::FileStatus> status = system::file_status(path);
  if (!status || !status->file) return false;
  out = {status->size, status->inode, status->modified, status->changed};
  return true;
}

FileStamp::FileStamp(const std::string& path) {
  const std::int64_t now = system::file_clock_nanoseconds();
  // the status is queried before reading, so that a change in between is detected by the next is_current()
  readable_ = query_status(path, status_) && hash_file(path, content_hash_);
  if (!readable_) content_hash_ = 0;
  times_reliable_ = readable_ && now - status_.changed > kTimeResolution;
}

bool FileStamp::is_current(const std::string& path) {
  FileStatus now;
  if (!query_status(path, now)) return !readable_;
  if (readable_ && times_reliable_ && now == status_) return true;
  const FileStamp fresh(path);
  if (!(fresh == *this)) return false;
  *this = fresh;
  return true;
}

}  // namespace limber::model
