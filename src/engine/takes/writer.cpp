// Queued data is swapped out as a block, and written in parts.
#include "engine/takes/writer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/text.h"
#include "engine/output/health.h"
#include "engine/presets/text.h"
#include "engine/takes/encoding.h"

namespace limber::engine {

namespace {

namespace fs = std::filesystem;

constexpr auto kWriteInterval = std::chrono::milliseconds(100);   // most that a crash can lose
constexpr std::size_t kFlushBytes = std::size_t{1} << 20u;        // from this size on data is written immediately
constexpr std::size_t kPartBytes = std::size_t{1} << 20u;         // written at a time: other files wait for it
constexpr std::size_t kSyncBytes = std::size_t{8} << 20u;         // bounds the time of a sync, for which others wait
constexpr std::size_t kMaxPendingBytes = std::size_t{64} << 20u;  // bounds the memory when the disk hangs

std::string numbered_path(const std::string& path, int n) {
  if (n == 1) return path;
  const fs::path full_path(path);
  return (full_path.parent_path() /
          fmt::format("{}-{}{}", full_path.stem().string(), n, full_path.extension().string()))
      .string();
}

}  // namespace

TakeWriter::TakeWriter(BackgroundWriter& writer, Target target, TakeHeader header,
                       std::function<void(const std::string&)> on_failure)
    : writer_(writer), target_(std::move(target)), header_(std::move(header)), on_failure_(std::move(on_failure)) {
  writer_.add(*this);
  if (writer_.request(*this)) return;
  error_ = "could not create a thread to write the take";
  failed_ = done_ = true;
}

TakeWriter::~TakeWriter() {
  close();
  writer_.finish(*this);
  writer_.remove(*this);
}

Result<void> TakeWriter::wait_until_open() {
  writer_.finish(*this);
  return error_.empty() ? Result<void>() : Result<void>(Error{error_});
}

void TakeWriter::write(std::string_view frames) {
  if (failed()) return;
  bool urgent = false;
  {
    const std::scoped_lock lock(mutex_);
    if (pending_.bytes.size() > kMaxPendingBytes) pending_.overflowed = true;
    if (pending_.overflowed) return;
    pending_.bytes.append(frames);
    urgent = pending_.bytes.size() >= kFlushBytes || std::exchange(first_write_, false);
  }
  const auto now = BackgroundWriter::Clock::now();
  (void)writer_.request(*this, urgent ? now : now + kWriteInterval);
}

void TakeWriter::write(Job job) {
  {
    const std::scoped_lock lock(mutex_);
    job.offset = pending_.bytes.size();
    pending_.jobs.push_back(std::move(job));
  }
  (void)writer_.request(*this);
}

void TakeWriter::write(TakeInitialState initial_state) { write(Job{0, std::move(initial_state), std::nullopt}); }

void TakeWriter::write(TakeFiles files) { write(Job{0, std::nullopt, std::move(files)}); }

void TakeWriter::close() {
  {
    const std::scoped_lock lock(mutex_);
    pending_.last = true;
  }
  (void)writer_.request(*this);
}

void TakeWriter::abandon() {
  {
    const std::scoped_lock lock(mutex_);
    pending_.abandoned = true;
  }
  close();
}

void TakeWriter::fail(const std::string& why) {
  if (failed_.exchange(true)) return;
  count_failed_write();
  on_failure_(fmt::format("{}: {}", printable(path_), why));
}

Result<void> TakeWriter::open_file() {
  std::error_code ignored;
  if (target_.make_unique) fs::create_directories(fs::path(target_.path).parent_path(), ignored);
  path_ = target_.path;
  if (Result<void> free = find_free_path(); !free) return free;
  // the writer of an earlier take with the same name may not have finished yet
  static std::atomic<int> serial{0};
  temporary_path_ = fmt::format("{}.{}-{}.part", target_.path, system::process_id(), ++serial);
  system::remove_file(temporary_path_);  // left by a killed program with the same process id
  file_ = system::open_file(temporary_path_, system::OpenMode::create_new);
  if (file_.is_open()) return {};
  return Error{fmt::format("{} can't be written: {}", printable(target_.path), system::error_reason())};
}

// Sets the path to the first name that doesn't exist.
Result<void> TakeWriter::find_free_path() {
  for (int n = 1; n < 10000; n++) {
    path_ = numbered_path(target_.path, n);
    if (!system::link_status(path_)) return {};
    if (!target_.make_unique) break;
  }
  return Error{
      fmt::format("{} exists already; takes never overwrite a file, so give another name", printable(target_.path))};
}

// Gives the file its final name. Called once it has a tick, so that a file with the name of a take can always be
// replayed, even if the program is killed.
void TakeWriter::rename_to_target() {
  for (int tries = 0; !temporary_path_.empty() && !failed(); tries++) {
    if (tries == 100) return fail("no free file name was found");
    if (!system::link_file(temporary_path_, path_)) {
      if (errno == EEXIST) {
        if (const Result<void> free = find_free_path(); !free) return fail(free.error());
        continue;
      }
      std::error_code failed;  // the file system has no hard links
      fs::rename(temporary_path_, path_, failed);
      if (failed) return fail(failed.message());
    } else {
      system::remove_file(temporary_path_);
    }
    temporary_path_.clear();
  }
}

void TakeWriter::append(std::string_view bytes) {
  if (failed() || system::write_all(file_.fd(), bytes)) return;
  fail(fmt::format("the take ends here, writing failed: {}", system::error_reason()));
}

// Returns the number of a content; writes its frame if it is new.
std::uint32_t TakeWriter::content_number(const std::string& bytes) {
  const auto [at, inserted] = content_numbers_.try_emplace(hash_bytes(bytes, bytes.size()), 0);
  if (!inserted) return at->second;
  at->second = static_cast<std::uint32_t>(content_numbers_.size());
  frame_.clear();
  append_frame(frame_, TakeFrame::content, bytes);
  append(frame_);
  return at->second;
}

void TakeWriter::append(const Job& job) {
  frame_.clear();
  if (job.initial_state) {
    append_frame(frame_, TakeFrame::begin, text_of(*job.initial_state));
    return append(frame_);
  }
  TakeFileList list;
  if (job.files->sources != nullptr) {
    script::SourcesRead read = job.files->sources->read();
    list.found = std::move(read.found);
    list.meshes = std::move(read.meshes);
    for (const auto& [path, text] : read.texts) list.files.emplace_back(path, content_number(text));
    for (const std::string& path : read.files) {
      std::ifstream in(path, std::ios::binary);
      const bool readable = static_cast<bool>(in);
      const std::string bytes{std::istreambuf_iterator<char>(in), {}};
      list.files.emplace_back(path, readable ? content_number(bytes) : 0);
    }
  }
  list.has_presets = job.files->presets.has_value();
  if (list.has_presets) list.presets = text_of(*job.files->presets);
  list.preset_file = job.files->preset_file;
  frame_.clear();
  append_frame(frame_, TakeFrame::files, text_of(list));
  append(frame_);
}

BackgroundWriter::Clock::time_point TakeWriter::run() {
  if (done()) return BackgroundWriter::kNever;
  if (!file_.is_open()) {
    if (const Result<void> open = open_file(); !open) {
      error_ = open.error();
      failed_ = done_ = true;
      count_failed_write();
      on_failure_(error_);
      return BackgroundWriter::kNever;
    }
    append(header_text(header_));
  }
  const bool fetch = block_is_written();
  if (fetch) fetch_block();
  write_part();
  if (block_is_written()) end_block();
  // the data of requests that came since the block was fetched is still queued
  return fetch && block_is_written() ? BackgroundWriter::kNever : BackgroundWriter::Clock::now();
}

void TakeWriter::fetch_block() {
  block_.bytes.clear();
  block_.jobs.clear();
  bytes_written_ = jobs_written_ = 0;
  const std::scoped_lock lock(mutex_);
  block_.bytes.swap(pending_.bytes);
  block_.jobs.swap(pending_.jobs);
  block_.last = pending_.last;
  block_.overflowed = pending_.overflowed;
  block_.abandoned = pending_.abandoned;
}

// Writes bytes up to the next job, or this job.
void TakeWriter::write_part() {
  const bool has_job = jobs_written_ < block_.jobs.size();
  const std::size_t end = has_job ? block_.jobs[jobs_written_].offset : block_.bytes.size();
  if (bytes_written_ < end) {
    const std::string_view part =
        std::string_view(block_.bytes).substr(bytes_written_, std::min(end - bytes_written_, kPartBytes));
    append(part);
    bytes_written_ += part.size();
    unsynced_bytes_ += part.size();
    if (unsynced_bytes_ < kSyncBytes) return;
    (void)system::sync_data(file_.fd());
    unsynced_bytes_ = 0;
  } else if (has_job) {
    append(block_.jobs[jobs_written_++]);
  }
}

void TakeWriter::end_block() {
  if (!block_.bytes.empty() && !block_.abandoned) rename_to_target();
  if (block_.overflowed) fail("the take ends here: the disk is too slow for it");
  if (!block_.last) return;
  if (block_.abandoned) system::remove_file(temporary_path_.empty() ? path_ : temporary_path_);
  (void)system::sync_data(file_.fd());
  file_ = {};
  done_.store(true);
}

}  // namespace limber::engine
