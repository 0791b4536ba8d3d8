// TakeWriter: writes a take to the disk in the background, so that a tick never waits for the disk. It only appends:
// data that was written stays valid if the program crashes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "engine/background_writer.h"
#include "engine/takes/take.h"

namespace limber::engine {

class TakeWriter : private BackgroundWriter::Task {
 public:
  /// The file to be written.
  struct Target {
    std::string path;
    /// If the file exists, append -2, -3 … to its name, and create the folder. False: an existing file is an error.
    bool make_unique = false;
  };
  /// `on_failure` is called once with the reason when writing fails. [the writer's thread]
  TakeWriter(BackgroundWriter& writer, Target target, TakeHeader header,
             std::function<void(const std::string&)> on_failure);
  /// Writes the pending data, and waits for it.
  ~TakeWriter() override;

  /// Waits until the file has been created, or returns the reason why it can't be. [any; sim only before the first
  /// tick]
  Result<void> wait_until_open();
  /// Queues encoded frames: copies them and never waits. They are written within 0.1 s. [sim]
  void write(std::string_view frames);
  /// Queue a frame that is encoded, with the files that it names, on the writer's thread. [sim]
  void write(TakeInitialState initial_state);
  void write(TakeFiles files);
  /// Ends the take without waiting. The file is complete once done() is true or the writer is destroyed. [sim]
  void close();
  /// Discards the take and deletes its file.
  void abandon();
  /// True if writing has failed: the take ends there. [any]
  bool failed() const { return failed_.load(); }
  /// True if everything was written or writing has failed: the destructor doesn't wait. [any]
  bool done() const { return done_.load(); }

 private:
  /// A frame that the writer's thread has to encode.
  struct Job {
    std::size_t offset = 0;  // offset in the data at which it belongs
    std::optional<TakeInitialState> initial_state;
    std::optional<TakeFiles> files;
  };
  /// Queued data.
  struct Block {
    std::string bytes;
    std::vector<Job> jobs;
    bool last = false;
    bool overflowed = false;
    bool abandoned = false;
  };
  void write(Job job);
  BackgroundWriter::Clock::time_point run() override;
  Result<void> open_file();
  Result<void> find_free_path();
  void rename_to_target();
  void fail(const std::string& why);
  bool block_is_written() const { return bytes_written_ == block_.bytes.size() && jobs_written_ == block_.jobs.size(); }
  void fetch_block();
  void write_part();
  void end_block();
  void append(std::string_view bytes);
  void append(const Job& job);
  std::uint32_t content_number(const std::string& bytes);

  BackgroundWriter& writer_;
  Target target_;
  TakeHeader header_;
  std::function<void(const std::string&)> on_failure_;
  std::atomic<bool> failed_{false};
  std::atomic<bool> done_{false};
  std::string error_;  // reason why the file couldn't be created
  // used only by the writer's thread:
  system::Descriptor file_;
  std::map<std::uint64_t, std::uint32_t> content_numbers_;  // numbers of content frames, by hash
  std::string frame_;
  std::string path_;                                  // the first unused name
  std::string temporary_path_;                        // temporary name of the file; empty once it has its final name
  Block block_;                                       // the data that is being written
  std::size_t bytes_written_ = 0, jobs_written_ = 0;  // of the block
  std::size_t unsynced_bytes_ = 0;

  std::mutex mutex_;  // never locked while writing
  Block pending_;
  bool first_write_ = true;  // nothing was queued yet
};

}  // namespace limber::engine
