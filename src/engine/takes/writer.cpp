// The mutex is locked only to swap the queued data out, never while writing.
#include "engine/takes/writer.h"

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
#include "engine/output/health.h"
#include "engine/presets/text.h"
#include "engine/takes/encoding.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

constexpr auto kWriteInterval = std::chrono::milliseconds(100);   // most that a crash can lose
constexpr std::size_t kFlushBytes = std::size_t{1} << 20u;        // from this size on data is written immediately
constexpr std::size_t kMaxPendingBytes = std::size_t{64} << 20u;  // bounds the memory when the disk hangs

std::string disk_reason() { return std::strerror(errno); }

std::string numbered_path(const std::string& path, int n) {
  if (n == 1) return path;
  const fs::path full_path(path);
  return (full_path.parent_path() /
          fmt::format("{}-{}{}", full_path.stem().string(), n, full_path.extension().string()))
      .string();
}

}  // namespace

TakeWriter::TakeWriter(Target target, TakeHeader header, std::function<void(const std::string&)> on_failure)
    : target_(std::move(target)), header_(std::move(header)), on_failure_(std::move(on_failure)) {
  if (system::start_thread(thread_, [this] { run(); })) return;
  error_ = "could not create a thread to write the take";
  failed_ = done_ = open_ = true;
}

TakeWriter::~TakeWriter() {
  close();
  if (thread_.joinable()) thread_.join();
}

Result<void> TakeWriter::wait_until_open() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return open_; });
  return error_.empty() ? Result<void>() : Result<void>(Error{error_});
}

void TakeWriter::write(std::string_view frames) {
  if (failed()) return;
  bool urgent = false;
  {
    const std::scoped_lock lock(mutex_);
    if (pending_.size() > kMaxPendingBytes) overflowed_ = true;
    if (overflowed_) return;
    pending_.append(frames);
    urgent = pending_.size() >= kFlushBytes || std::exchange(first_write_, false);
  }
  if (urgent) changed_.notify_all();
}

void TakeWriter::write(TakeInitialState initial_state) {
  {
    const std::scoped_lock lock(mutex_);
    jobs_.push_back({pending_.size(), std::move(initial_state), std::nullopt});
  }
  changed_.notify_all();
}

void TakeWriter::write(TakeFiles files) {
  {
    const std::scoped_lock lock(mutex_);
    jobs_.push_back({pending_.size(), std::nullopt, std::move(files)});
  }
  changed_.notify_all();
}

void TakeWriter::close() {
  {
    const std::scoped_lock lock(mutex_);
    closing_ = true;
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
  count_failed_write();
  on_failure_(fmt::format("{}: {}", printable(target_.path), why));
}

Result<void> TakeWriter::open_file() {
  std::error_code ignored;
  if (target_.make_unique) fs::create_directories(fs::path(target_.path).parent_path(), ignored);
  const std::string requested_path = target_.path;
  if (Result<void> free = find_free_path(requested_path); !free) return free;
  // the writer of an earlier take with the same name may not have finished yet
  static std::atomic<int> serial{0};
  temporary_path_ = fmt::format("{}.{}-{}.part", requested_path, system::process_id(), ++serial);
  system::remove_file(temporary_path_);  // left by a killed program with the same process id
  file_ = system::open_file(temporary_path_, system::OpenMode::create_new);
  if (file_.is_open()) return {};
  return Error{fmt::format("{} can't be written: {}", printable(requested_path), disk_reason())};
}

// Sets the target path to the first name that doesn't exist.
Result<void> TakeWriter::find_free_path(const std::string& requested_path) {
  for (int n = 1; n < 10000; n++) {
    const std::string path = numbered_path(requested_path, n);
    if (!system::link_status(path)) {
      const std::scoped_lock lock(mutex_);
      target_.path = path;
      return {};
    }
    if (!target_.make_unique) break;
  }
  return Error{
      fmt::format("{} exists already; takes never overwrite a file, so give another name", printable(requested_path))};
}

// Gives the file its final name. Called once it has a tick, so that a file with the name of a take can always be
// replayed, even if the program is killed.
void TakeWriter::rename_to_target(const std::string& requested_path) {
  for (int tries = 0; !temporary_path_.empty() && !failed(); tries++) {
    if (tries == 100) return fail("no free file name was found");
    if (!system::link_file(temporary_path_, target_.path)) {
      if (errno == EEXIST) {
        if (const Result<void> free = find_free_path(requested_path); !free) return fail(free.error());
        continue;
      }
      std::error_code failed;  // the file system has no hard links
      fs::rename(temporary_path_, target_.path, failed);
      if (failed) return fail(failed.message());
    } else {
      system::remove_file(temporary_path_);
    }
    temporary_path_.clear();
  }
}

void TakeWriter::append(std::string_view bytes) {
  if (failed() || system::write_all(file_.fd(), bytes)) return;
  fail(fmt::format("the take ends here, writing failed: {}", disk_reason()));
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
    SourcesRead read = job.files->sources->read();
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

void TakeWriter::write_all(std::string_view bytes, std::vector<Job>& jobs) {
  std::size_t at = 0;
  for (const Job& job : jobs) {
    append(bytes.substr(at, job.offset - at));
    at = job.offset;
    append(job);
  }
  append(bytes.substr(at));
}

void TakeWriter::run() {
  system::name_this_thread("limber-take");
  const std::string requested_path = target_.path;
  const Result<void> open = open_file();
  if (open) append(header_text(header_));
  if (!open) failed_.store(true);
  {
    const std::scoped_lock lock(mutex_);
    open_ = true;
    if (!open) error_ = open.error();
  }
  changed_.notify_all();
  if (!open) {
    count_failed_write();
    on_failure_(open.error());
    done_.store(true);
    return;
  }
  std::string pending;
  std::vector<Job> jobs;
  for (bool end = false, overflowed = false, abandoned = false; !end;) {
    pending.clear();
    jobs.clear();
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kWriteInterval, [this] {
        return closing_ || !jobs_.empty() || pending_.size() >= (temporary_path_.empty() ? kFlushBytes : 1);
      });
      end = closing_;
      abandoned = abandoned_;
      overflowed = overflowed_;
      pending.swap(pending_);
      jobs.swap(jobs_);
    }
    write_all(pending, jobs);
    if (!pending.empty() && !abandoned) rename_to_target(requested_path);
    if (overflowed) fail("the take ends here: the disk is too slow for it");
  }
  if (abandoned_) system::remove_file(temporary_path_.empty() ? target_.path : temporary_path_);
  (void)system::sync_data(file_.fd());
  file_ = {};
  done_.store(true);
}

}  // namespace limber
