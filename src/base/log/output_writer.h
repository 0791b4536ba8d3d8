// OutputWriter: queues text from any thread and writes it to several devices in its own thread, so that a device that
// is full, closed, slow or not read does not block callers.
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

#include "base/log/text_queue.h"
#include "base/system/standard_output.h"

namespace limber {

class OutputDevice {
 public:
  virtual ~OutputDevice() = default;
  /// Waits at most `limit` for the device to be ready and writes as many bytes as it accepts. [writer]
  virtual system::Written write(std::string_view bytes, std::chrono::nanoseconds limit) = 0;
};

/// A device and its queue.
struct OutputStream {
  /// Behavior of write() when the queue is full.
  enum class Full : std::uint8_t {
    drop,        ///< Drops the text.
    wait_while,  ///< Waits for space while the device accepts data at least once a second; drops otherwise.
    wait,        ///< Waits for space until begin_shutdown() is called or a signal that ends the program is pending.
  };

  std::unique_ptr<OutputDevice> device;
  Full full = Full::drop;
  bool inserts_notice = true;                       ///< Insert a line with the number of lost lines in the output.
  std::function<void(int error)> on_loss;           ///< Called for the first lost line; 0: queue full. [writer]
  std::function<void(std::uint64_t lines)> on_gap;  ///< Called when the device accepts text after a loss. [writer]
};

/// Owns the queues of all streams and the thread that writes them.
class OutputWriter {
 public:
  static constexpr std::size_t kQueueBytes = 256 << 10;   ///< Capacity of each queue in bytes.
  static constexpr std::size_t kQueueTexts = 4096;        ///< Capacity of each queue in texts.
  static constexpr std::size_t kMaxTextBytes = 64 << 10;  ///< A longer text is shortened, or split if the stream waits.
  using Clock = std::chrono::steady_clock;

  explicit OutputWriter(std::vector<OutputStream> streams, std::size_t bytes = kQueueBytes,
                        std::size_t texts = kQueueTexts);
  /// Stops the thread after its current write.
  ~OutputWriter();
  OutputWriter(const OutputWriter&) = delete;
  OutputWriter& operator=(const OutputWriter&) = delete;

  /// Starts the thread. False if the system can't start another thread.
  bool start();
  /// Lets the thread run until the program exits; the caller must never destroy this object.
  void detach() { thread_.detach(); }

  /// Queues the text, which must end with a newline. [any]
  void write(std::size_t stream, std::string_view text) noexcept;
  /// Limits further waits for a device to half a second, because the program is about to exit. [any]
  void begin_shutdown() { shutting_down_.store(true); }
  bool shutting_down() const { return shutting_down_.load(); }
  /// Waits until the queued text is written or lost. False if the device accepted nothing for the time `timeout`, or
  /// not everything in four times that. nullopt: no limit until begin_shutdown() is called or a signal is pending.
  bool drain(std::size_t stream, std::optional<std::chrono::nanoseconds> timeout);
  /// Returns the number of lost lines. [any]
  std::uint64_t lost(std::size_t stream) const;

 private:
  struct StreamState {
    StreamState(OutputStream&& from, std::size_t bytes, std::size_t texts)
        : stream(std::move(from)), queue(bytes, texts) {}
    OutputStream stream;
    std::mutex pieces_mutex;  // keeps the pieces of a split text together
    // guarded by mutex_
    TextQueue queue;
    std::uint64_t dropped = 0;  // since the last text in the queue
    std::uint64_t lost = 0;
    bool dropping = false;       // until the queue is half empty
    bool loss_reported = false;  // on_loss was called for this loss
    bool writing = false;        // the thread is writing `text`
    bool stalled = false;
    Clock::time_point last_progress;  // when the device last accepted data
    // used by the thread only
    std::string text;
    std::size_t at = 0;
    std::uint64_t order = 0;
    std::uint64_t missing = 0;  // lost lines that were not reported to the device yet
    std::uint64_t lines = 0;    // in `text`
    bool failing = false;
    bool open_line = false;  // the last byte written is not a newline
  };
  enum class Step : std::uint8_t { none, some };

  static bool busy(const StreamState& state) { return state.writing || !state.queue.empty() || state.dropped > 0; }
  static bool has_space(const StreamState& state, std::size_t size);
  void push(StreamState& state, std::string_view text);
  void wait_for_space(std::unique_lock<std::mutex>& lock, StreamState& state, std::size_t size);
  void run();
  bool load(StreamState& state);
  Step advance();
  Step advance(StreamState& state, std::chrono::nanoseconds limit);
  void end_text(StreamState& state, int error);

  std::vector<std::unique_ptr<StreamState>> streams_;
  std::vector<StreamState*> writing_;  // used by the thread only
  mutable std::mutex mutex_;
  std::condition_variable changed_;   // wakes the thread
  std::condition_variable progress_;  // wakes callers of write() and drain()
  std::uint64_t order_ = 0;
  bool stopping_ = false;
  std::atomic<bool> shutting_down_{false};
  std::thread thread_;
};

}  // namespace limber
