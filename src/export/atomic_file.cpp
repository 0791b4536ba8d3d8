// Buffers writes to reduce system calls; opens the file for each flush only.
#include "export/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/system/process.h"
#include "base/text.h"

namespace limber::exporter {

using system::OpenMode;

namespace {

constexpr std::size_t kBufferBytes = std::size_t{64} << 10u;

}  // namespace

std::string temporary_name(const std::string& path) { return fmt::format("{}.{}.new", path, system::process_id()); }

AtomicFile::AtomicFile(std::string path, std::string temporary_path)
    : path_(std::move(path)), temporary_path_(std::move(temporary_path)) {}

AtomicFile::~AtomicFile() {
  if (open_) system::remove_file(temporary_path_);
}

Error AtomicFile::failed() const {
  return Error{fmt::format("{} can't be written: {}", printable(path_), std::generic_category().message(errno))};
}

Result<void> AtomicFile::open() {
  const system::Descriptor file = system::open_file(temporary_path_, OpenMode::replace);
  if (!file.is_open()) return failed();
  open_ = true;
  return {};
}

Result<void> AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  size_ += bytes.size();
  return buffer_.size() < kBufferBytes ? Result<void>() : flush();
}

Result<void> AtomicFile::flush() {
  const system::Descriptor file = system::open_file(temporary_path_, OpenMode::append);
  if (!file.is_open() || !system::write_all(file.fd(), buffer_)) return failed();
  buffer_.clear();
  return {};
}

Result<void> AtomicFile::patch(std::uint64_t at, std::string_view bytes) {
  if (Result<void> flushed = flush(); !flushed) return flushed;
  const system::Descriptor file = system::open_file(temporary_path_, OpenMode::write);
  if (!file.is_open() || !system::seek_to(file.fd(), at) || !system::write_all(file.fd(), bytes)) return failed();
  return {};
}

Result<void> AtomicFile::finish() {
  if (Result<void> flushed = flush(); !flushed) return flushed;
  {
    const system::Descriptor file = system::open_file(temporary_path_, OpenMode::write);
    if (!file.is_open() || !system::sync_file(file.fd())) return failed();
  }
  if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0) return failed();
  open_ = false;
  return {};
}

}  // namespace limber::exporter
