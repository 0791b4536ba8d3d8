// LightingOutput: the thread that sends the values of fixtures to lights, from the snapshots of the simulation.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/result.h"
#include "base/system/clock.h"
#include "base/system/net/udp_socket.h"
#include "base/system/wake.h"
#include "engine/output/engine_link.h"
#include "net/lighting/options.h"
#include "net/lighting/serial_sender.h"
#include "net/lighting/stream.h"

namespace limber::lighting {

/// `link` must outlive the output.
class LightingOutput {
 public:
  LightingOutput(engine::EngineLink& link, LightingOptions options);
  ~LightingOutput();
  LightingOutput(const LightingOutput&) = delete;
  LightingOutput& operator=(const LightingOutput&) = delete;

  /// Starts the thread, if there are targets. A socket that can't be opened is reported, and opened later. [main]
  void start();
  /// Ends output as the options say, and stops the thread. Idempotent. [main]
  void stop();
  /// Tells the thread that there is a new snapshot. [any]
  void notify() {
    if (active_.load(std::memory_order_relaxed)) wake_.notify();
  }
  /// One line per target: "lights: sACN multicast, priority 100, at most 44 Hz". [any]
  std::vector<std::string> status_lines() const;

 private:
  struct Output {
    Output(LightTarget target, const Cid& cid, LightStream::Send send)
        : stream(std::move(target), cid, std::move(send)) {}
    bool is_open() const { return socket.is_open() || serial.is_open(); }
    system::UdpSocket socket;
    SerialSender serial;  // instead of the socket
    LightStream stream;
    std::int64_t retry_at = 0;  // ns
    int reported_error = 0;     // the last one that was logged
  };
  void run();
  void send(Output& output, const system::Endpoint& to, const std::string& packet);
  void open(Output& output, std::int64_t now);
  Result<void> open_target(Output& output);
  void report(Output& output, int error);
  /// Waits until there is a new snapshot, or the time `next` (ns); meanwhile, continues to write to serial ports.
  void wait_until(std::int64_t next);
  /// Sends the packets that are due. Returns the time of the next call, ns.
  std::int64_t send_due(std::int64_t now);

  engine::EngineLink& link_;
  const LightingOptions options_;
  ArmLatch latch_;
  std::vector<std::unique_ptr<Output>> outputs_;
  system::Wake wake_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> active_{false};
  bool sends_ = false;
};

}  // namespace limber::lighting
