// OutputWriter: text for several devices, queued by any thread and written by one thread of its own, so that a device
// that is full, closed, slow or not read by anyone delays no caller.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/system/standard_output.h"
#include "base/text_queue.h"

namespace limber {

class OutputDevice {
 public:
  virtual ~OutputDevice() = default;
  /// Writes the beginning of the bytes as soon as the device is ready, and waits at most `limit` for that. [writer]
  virtual system::Written write(std::string_view bytes, std::chrono::nanoseconds limit) = 0;
};

/// A device and its queue.
struct OutputStream {
  /// What write() does when the queue is full.
  enum class Full : std::uint8_t {
    drop,        ///< Drops the text.
    wait_while,  ///< Waits for room while the device takes something at least once a second; drops otherwise.
    wait,        ///< Waits for room until hurry() is called or a signal that ends the program is pending.
  };

  std::unique_ptr<OutputDevice> device;
  Full full = Full::drop;
  bool counts = true;                               ///< Writes the number of lost lines where they are missing.
  std::function<void(int error)> on_loss;           ///< The first line is lost; 0: the queue is full. [writer]
  std::function<void(std::uint64_t lines)> on_gap;  ///< The device has taken text again after a loss. [writer]
};

class OutputWriter {
 public:
  static constexpr std::size_t kBytes = 256 << 10;   ///< Of each queue.
  static constexpr std::size_t kTexts = 4096;        ///< The same.
  static constexpr std::size_t kLongest = 64 << 10;  ///< A longer text is shortened, or written in pieces by waiting.
  using Clock = std::chrono::steady_clock;

  explicit OutputWriter(std::vector<OutputStream> streams, std::size_t bytes = kBytes, std::size_t texts = kTexts);
  /// Ends the thread after the write that it is in.
  ~OutputWriter();
  OutputWriter(const OutputWriter&) = delete;
  OutputWriter& operator=(const OutputWriter&) = delete;

  /// False: the system has no thread left.
  bool start();
  /// The thread runs until the program ends; this object is never destroyed.
  void detach() { thread_.detach(); }

  /// Queues the text, which ends with a newline. [any]
  void write(std::size_t stream, std::string_view text) noexcept;
  /// The program is about to end: from here on nothing waits for a device longer than half a second. [any]
  void hurry() { hurried_.store(true); }
  bool hurried() const { return hurried_.load(); }
  /// Waits until everything queued is written or lost. False: the device took nothing for as long as `patience`
  /// (nothing: without limit until hurry() is called or a signal is pending), or not everything in four times that.
  bool drain(std::size_t stream, std::optional<std::chrono::nanoseconds> patience);
  /// Lines that were not written. [any]
  std::uint64_t lost(std::size_t stream) const;

 private:
  struct Lane {
    Lane(OutputStream&& from, std::size_t bytes, std::size_t texts) : stream(std::move(from)), queue(bytes, texts) {}
    OutputStream stream;
    std::mutex turn;  // of texts in pieces
    // under mutex_
    TextQueue queue;
    std::uint64_t dropped = 0;  // since the last text in the queue
    std::uint64_t lost = 0;
    bool dropping = false;  // until the queue is half empty
    bool told = false;      // on_loss was called for it
    bool writing = false;   // the thread has a text
    bool stalled = false;
    Clock::time_point moved;  // when the device last took something
    // the thread's
    std::string text;
    std::size_t at = 0;
    std::uint64_t order = 0;
    std::uint64_t missing = 0;  // lines that the device has not been told of
    std::uint64_t lines = 0;    // in `text`
    bool failing = false;
    bool open_line = false;  // the last byte written is not a newline
  };
  enum class Step : std::uint8_t { none, some };

  static bool busy(const Lane& lane) { return lane.writing || !lane.queue.empty() || lane.dropped > 0; }
  static bool has_room(const Lane& lane, std::size_t size);
  void push(Lane& lane, std::string_view text);
  void wait_for_room(std::unique_lock<std::mutex>& lock, Lane& lane, std::size_t size);
  void run();
  bool load(Lane& lane);
  Step advance();
  Step advance(Lane& lane, std::chrono::nanoseconds limit);
  void end_text(Lane& lane, int error);

  std::vector<std::unique_ptr<Lane>> lanes_;
  std::vector<Lane*> writing_;  // the thread's
  mutable std::mutex mutex_;
  std::condition_variable changed_;   // for the thread
  std::condition_variable progress_;  // for who waits for it
  std::uint64_t order_ = 0;
  bool ending_ = false;
  std::atomic<bool> hurried_{false};
  std::thread thread_;
};

}  // namespace limber
