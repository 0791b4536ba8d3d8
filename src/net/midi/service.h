// MidiService: the thread that connects MIDI devices with the simulation: movements of controls become messages, values
// and the beat go back to the devices.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "base/system/wake.h"
#include "engine/output/engine_link.h"
#include "net/midi/clock/clocks.h"
#include "net/midi/devices.h"
#include "net/midi/mapping.h"
#include "net/midi/options.h"

namespace limber::midi {

/// `link` must outlive the service.
class MidiService {
 public:
  static constexpr std::int64_t kBatchInterval = 1'000'000;     ///< ns between two batches of messages.
  static constexpr std::int64_t kIdleInterval = 500'000'000;    ///< ns
  static constexpr std::int64_t kStatusInterval = 100'000'000;  ///< ns
  static constexpr std::int64_t kClockInterval = 2'000'000;     ///< ns between two readings of the beat.
  static constexpr std::int64_t kGestureGap = 500'000'000;      ///< ns of rest after which an undo step begins.

  /// `now` returns the time in ns; tests replace it.
  MidiService(engine::EngineLink& link, MidiOptions options, std::unique_ptr<PortSystem> ports = system_ports(),
              std::function<std::int64_t()> now = system::clock_nanoseconds);
  ~MidiService();
  MidiService(const MidiService&) = delete;
  MidiService& operator=(const MidiService&) = delete;

  /// Accepts requests to learn, and starts the thread, unless MIDI is off. The engine must not run yet. [main]
  void start();
  /// Stops the thread and closes the devices. Idempotent. [main]
  void stop();
  /// Uses the map of another scene. [any]
  void set_scene(const std::string& scene);
  /// Handles requests, received bytes, feedback and the clock: one round of the thread's loop. Returns the time of the
  /// next call, ns; bytes that arrive make it earlier.
  /// [the thread; tests without one]
  std::int64_t update();

 private:
  struct Request {
    Message message;
    CommandOrigin origin;
    friend std::size_t weight_of(const Request& request) { return sizeof request + engine::weight_of(request.message); }
  };
  struct Times {  // ns
    std::int64_t batch = 0, feedback = 0, status = 0, values = 0, clock = 0, moved = 0;
  };
  void run();
  bool is_on() const;
  void handle_requests();
  void handle(const Request& request);
  void finish_learning(std::int64_t now);
  void fail(const CommandOrigin& to, std::string_view address, const std::string& text);
  void scan_devices(std::int64_t now);
  void accept_bytes();
  void accept_message(Device& device, const MidiMessage& message, std::int64_t time);
  void push_messages(std::int64_t now);
  std::uint64_t push(std::vector<Message> messages, std::uint16_t gesture);
  void read_values(std::int64_t now);
  void send_feedback(std::int64_t now);
  std::int64_t next_time(std::int64_t now) const;
  void publish(std::int64_t now);

  engine::EngineLink& link_;
  const MidiOptions options_;
  const std::unique_ptr<PortSystem> ports_;
  const std::function<std::int64_t()> now_;
  system::Wake wake_;
  BoundedQueue<Request> requests_{256, std::size_t{1} << 20};
  std::mutex scene_mutex_;
  std::optional<std::string> scene_;  // the next scene; guarded by scene_mutex_

  // of the thread
  Devices devices_;
  Mapping mapping_;
  CommandOrigin learn_origin_;
  Clocks clocks_;
  Times times_;
  std::optional<std::int64_t> next_pulse_;
  std::uint16_t gesture_ = 1;  // number of the movement, for undo
  std::string last_event_;
  std::vector<MidiBytes> received_;  // scratch

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace limber::midi
