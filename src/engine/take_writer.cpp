// The lock is held to take what has come, never while it is written.
#include "engine/take_writer.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/system/thread.h"
#include "base/text.h"
#include "engine/health.h"
#include "engine/preset_text.h"
#include "engine/take_text.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

constexpr auto kEvery = std::chrono::milliseconds(100);       // what a crash may cost
constexpr std::size_t kSoon = std::size_t{1} << 20u;          // more is written at once
constexpr std::size_t kMostPending = std::size_t{64} << 20u;  // a disk that hangs fills no memory

std::string disk_reason() { return std::strerror(errno); }

std::string numbered(const std::string& path, int n) {
  if (n == 1) return path;
  const fs::path whole(path);
  return (whole.parent_path() / fmt::format("{}-{}{}", whole.stem().string(), n, whole.extension().string())).string();
}

}  // namespace

TakeWriter::TakeWriter(Place place, TakeHeader header, std::function<void(const std::string&)> failed)
    : place_(std::move(place)), header_(std::move(header)), tell_failed_(std::move(failed)) {
  if (system::start_thread(thread_, [this] { run(); })) return;
  error_ = "the system has no thread left to write the take";
  failed_ = done_ = open_ = true;
}

TakeWriter::~TakeWriter() {
  close();
  if (thread_.joinable()) thread_.join();
}

Result<void> TakeWriter::opened() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return open_; });
  return error_.empty() ? Result<void>() : Result<void>(Error{error_});
}

void TakeWriter::write(std::string_view frames) {
  if (failed()) return;
  bool soon = false;
  {
    const std::scoped_lock lock(mutex_);
    if (bytes_.size() > kMostPending) full_ = true;
    if (full_) return;
    bytes_.append(frames);
    soon = bytes_.size() >= kSoon || std::exchange(first_, false);
  }
  if (soon) changed_.notify_all();
}

void TakeWriter::write(TakeBegin begin) {
  {
    const std::scoped_lock lock(mutex_);
    jobs_.push_back({bytes_.size(), std::move(begin), std::nullopt});
  }
  changed_.notify_all();
}

void TakeWriter::write(TakeFiles files) {
  {
    const std::scoped_lock lock(mutex_);
    jobs_.push_back({bytes_.size(), std::nullopt, std::move(files)});
  }
  changed_.notify_all();
}

void TakeWriter::close() {
  {
    const std::scoped_lock lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
}

void TakeWriter::abandon() {
  {
    const std::scoped_lock lock(mutex_);
    abandoned_ = true;
  }
  close();
}

void TakeWriter::fail(const std::string& why) {
  if (failed_.exchange(true)) return;
  note_failed_write();
  tell_failed_(fmt::format("{}: {}", printable(place_.path), why));
}

Result<void> TakeWriter::open_file() {
  std::error_code ignored;
  if (place_.numbered) fs::create_directories(fs::path(place_.path).parent_path(), ignored);
  const std::string first = place_.path;
  if (Result<void> free = find_name(first); !free) return free;
  part_ = fmt::format("{}.{}.part", first, system::process_id());
  system::remove_file(part_);  // of a program of that number, which was killed
  file_ = system::open_file(part_, system::OpenMode::create_new);
  if (file_.open()) return {};
  return Error{fmt::format("{} can't be written: {}", printable(first), disk_reason())};
}

// the first name that is free
Result<void> TakeWriter::find_name(const std::string& first) {
  for (int n = 1; n < 10000; n++) {
    const std::string path = numbered(first, n);
    if (!system::link_status(path)) {
      const std::scoped_lock lock(mutex_);
      place_.path = path;
      return {};
    }
    if (!place_.numbered) break;
  }
  return Error{fmt::format("{} is there already; a take writes over nothing, so give another name", printable(first))};
}

// A file has the name of a take once a tick is in it: whenever the program is killed, it can be played.
void TakeWriter::give_name(const std::string& first) {
  for (int tries = 0; !part_.empty() && !failed(); tries++) {
    if (tries == 100) return fail("other programs take every name that is free");
    if (!system::link_file(part_, place_.path)) {
      if (errno == EEXIST) {
        if (const Result<void> free = find_name(first); !free) return fail(free.error());
        continue;
      }
      std::error_code failed;  // a file system without links
      fs::rename(part_, place_.path, failed);
      if (failed) return fail(failed.message());
    } else {
      system::remove_file(part_);
    }
    part_.clear();
  }
}

void TakeWriter::put(std::string_view bytes) {
  if (failed() || system::write_all(file_.fd(), bytes)) return;
  fail(fmt::format("the take ends here, the disk takes no more: {}", disk_reason()));
}

// the number of a content; it is written where it is new
std::uint32_t TakeWriter::content(const std::string& bytes) {
  const auto [at, fresh] = contents_.try_emplace(hash_bytes(bytes, bytes.size()), 0);
  if (!fresh) return at->second;
  at->second = static_cast<std::uint32_t>(contents_.size());
  frame_.clear();
  append_frame(frame_, TakeFrame::content, bytes);
  put(frame_);
  return at->second;
}

void TakeWriter::put(const Job& job) {
  frame_.clear();
  if (job.begin) {
    append_frame(frame_, TakeFrame::begin, text_of(*job.begin));
    return put(frame_);
  }
  TakeFileList list;
  if (job.files->sources != nullptr) {
    SourcesRead read = job.files->sources->read();
    list.found = std::move(read.found);
    list.meshes = std::move(read.meshes);
    for (const auto& [path, text] : read.texts) list.files.emplace_back(path, content(text));
    for (const std::string& path : read.files) {
      std::ifstream in(path, std::ios::binary);
      const bool there = static_cast<bool>(in);
      const std::string bytes{std::istreambuf_iterator<char>(in), {}};
      list.files.emplace_back(path, there ? content(bytes) : 0);
    }
  }
  list.has_presets = job.files->presets.has_value();
  if (list.has_presets) list.presets = text_of(*job.files->presets);
  list.preset_file = job.files->preset_file;
  frame_.clear();
  append_frame(frame_, TakeFrame::files, text_of(list));
  put(frame_);
}

void TakeWriter::write_all(std::string_view bytes, std::vector<Job>& jobs) {
  std::size_t at = 0;
  for (const Job& job : jobs) {
    put(bytes.substr(at, job.at - at));
    at = job.at;
    put(job);
  }
  put(bytes.substr(at));
}

void TakeWriter::run() {
  system::name_this_thread("limber-take");
  const std::string first = place_.path;
  const Result<void> open = open_file();
  if (open) put(head_text(header_));
  if (!open) failed_.store(true);
  {
    const std::scoped_lock lock(mutex_);
    open_ = true;
    if (!open) error_ = open.error();
  }
  changed_.notify_all();
  if (!open) {
    note_failed_write();
    tell_failed_(open.error());
    done_.store(true);
    return;
  }
  std::string bytes;
  std::vector<Job> jobs;
  for (bool end = false, full = false, drop = false; !end;) {
    bytes.clear();
    jobs.clear();
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kEvery,
                        [this] { return end_ || !jobs_.empty() || bytes_.size() >= (part_.empty() ? kSoon : 1); });
      end = end_;
      drop = abandoned_;
      full = full_;
      bytes.swap(bytes_);
      jobs.swap(jobs_);
    }
    write_all(bytes, jobs);
    if (!bytes.empty() && !drop) give_name(first);
    if (full) fail("the take ends here: the disk is too slow for it");
  }
  if (abandoned_) system::remove_file(part_.empty() ? place_.path : part_);
  (void)system::sync_data(file_.fd());
  file_ = {};
  done_.store(true);
}

}  // namespace limber
