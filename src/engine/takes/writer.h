// TakeWriter: writes a take to the disk on its own thread, so that a tick never waits for the disk. It only appends:
// data that was written stays valid if the program crashes.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/result.h"
#include "base/system/descriptor.h"
#include "engine/takes/take.h"

namespace limber {

class TakeWriter {
 public:
  /// The file to be written.
  struct Target {
    std::string path;
    /// If the file exists, append -2, -3 … to its name, and create the folder. False: an existing file is an error.
    bool make_unique = false;
  };
  /// `on_failure` is called once with the reason when writing fails. [the writer's thread]
  TakeWriter(Target target, TakeHeader header, std::function<void(const std::string&)> on_failure);
  /// Writes the pending data, and waits for it.
  ~TakeWriter();
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;

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
    std::size_t offset = 0;  // offset in the pending data at which it belongs
    std::optional<TakeInitialState> initial_state;
    std::optional<TakeFiles> files;
  };
  void run();
  Result<void> open_file();
  Result<void> find_free_path(const std::string& requested_path);
  void rename_to_target(const std::string& requested_path);
  void fail(const std::string& why);
  void append(std::string_view bytes);
  void append(const Job& job);
  std::uint32_t content_number(const std::string& bytes);
  void write_all(std::string_view bytes, std::vector<Job>& jobs);

  Target target_;
  TakeHeader header_;
  std::function<void(const std::string&)> on_failure_;
  std::atomic<bool> failed_{false};
  std::atomic<bool> done_{false};
  // used only by the thread:
  system::Descriptor file_;
  std::map<std::uint64_t, std::uint32_t> content_numbers_;  // numbers of content frames, by hash
  std::string frame_;
  std::string temporary_path_;  // temporary name of the file; empty once it has its final name

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string pending_;  // pending data
  std::vector<Job> jobs_;
  bool first_write_ = true;  // nothing was queued yet
  bool open_ = false;
  bool closing_ = false;
  bool overflowed_ = false;
  bool abandoned_ = false;
  std::string error_;
  std::thread thread_;
};

}  // namespace limber
