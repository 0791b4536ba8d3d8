// Gathers what is put, so that the disk is asked seldom.
#include "motion/out_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/descriptor.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kGathered = std::size_t{64} << 10u;

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

}  // namespace

std::string beside_name(const std::string& path) { return fmt::format("{}.{}.new", path, getpid()); }

OutFile::OutFile(std::string path, std::string beside) : path_(std::move(path)), beside_(std::move(beside)) {}

OutFile::~OutFile() {
  if (open_) ::unlink(beside_.c_str());
}

Error OutFile::failed() const {
  return Error{fmt::format("{} can't be written: {}", printable(path_), std::generic_category().message(errno))};
}

Result<void> OutFile::open() {
  const Descriptor file(::open(beside_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (!file.open()) return failed();
  open_ = true;
  return {};
}

Result<void> OutFile::put(std::string_view bytes) {
  waiting_.append(bytes);
  size_ += bytes.size();
  return waiting_.size() < kGathered ? Result<void>() : flush();
}

Result<void> OutFile::flush() {
  const Descriptor file(::open(beside_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (!file.open() || !write_all(file.fd(), waiting_)) return failed();
  waiting_.clear();
  return {};
}

Result<void> OutFile::patch(std::uint64_t at, std::string_view bytes) {
  if (Result<void> flushed = flush(); !flushed) return flushed;
  const Descriptor file(::open(beside_.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.open() || ::lseek(file.fd(), static_cast<off_t>(at), SEEK_SET) < 0 || !write_all(file.fd(), bytes))
    return failed();
  return {};
}

Result<void> OutFile::finish() {
  if (Result<void> flushed = flush(); !flushed) return flushed;
  {
    const Descriptor file(::open(beside_.c_str(), O_WRONLY | O_CLOEXEC));
    if (!file.open() || ::fsync(file.fd()) != 0) return failed();
  }
  if (std::rename(beside_.c_str(), path_.c_str()) != 0) return failed();
  open_ = false;
  return {};
}

}  // namespace limber
