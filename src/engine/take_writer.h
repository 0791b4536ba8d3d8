// TakeWriter: brings a take to the disk on a thread of its own, so that a tick never waits for one. It only appends:
// what was written stays good whatever happens after.
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
#include "engine/take.h"

namespace limber {

class TakeWriter {
 public:
  struct Place {
    std::string path;
    bool numbered =
        false;  ///< Where that is taken, with -2, -3 … behind its name; in a folder that is made. Else refused.
  };
  /// `failed` is told why no more can be written. [the writer's thread]
  TakeWriter(Place place, TakeHeader header, std::function<void(const std::string&)> failed);
  /// What was to be written is written before it goes.
  ~TakeWriter();
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;

  /// Waits until the file is there, or can't be. [any but sim, while time goes]
  Result<void> opened();
  /// Soon these frames are on the disk. Copies, and waits for nothing. [sim]
  void write(std::string_view frames);
  /// So are these, made of what they name on the writer's thread. [sim]
  void write(TakeBegin begin);
  void write(TakeFiles files);
  /// Nothing more comes. Waits for nothing; the file is whole once the writer has gone. [sim]
  void close();
  /// A take that has not begun after all: its file goes.
  void abandon();
  /// No more can be written. [any]
  bool failed() const { return failed_.load(); }
  /// All is on the disk, or can't be: it may go without a wait. [any]
  bool done() const { return done_.load(); }

 private:
  struct Job {
    std::size_t at = 0;  // behind so many bytes
    std::optional<TakeBegin> begin;
    std::optional<TakeFiles> files;
  };
  void run();
  Result<void> open_file();
  Result<void> find_name(const std::string& first);
  void give_name(const std::string& first);
  void fail(const std::string& why);
  void put(std::string_view bytes);
  void put(const Job& job);
  std::uint32_t content(const std::string& bytes);
  void write_all(std::string_view bytes, std::vector<Job>& jobs);

  Place place_;
  TakeHeader header_;
  std::function<void(const std::string&)> tell_failed_;
  std::atomic<bool> failed_{false};
  std::atomic<bool> done_{false};
  // of the thread
  system::Descriptor file_;
  std::map<std::uint64_t, std::uint32_t> contents_;  // numbers by hash
  std::string frame_;
  std::string part_;  // the file's name until it gets that of a take; empty: it has it

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string bytes_;  // what is to be written
  std::vector<Job> jobs_;
  bool first_ = true;  // nothing has come yet
  bool open_ = false;
  bool end_ = false;
  bool full_ = false;
  bool abandoned_ = false;
  std::string error_;
  std::thread thread_;
};

}  // namespace limber
