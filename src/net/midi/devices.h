// Devices: opens the MIDI ports that match, follows devices that are unplugged and return, and collects what arrives.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/threads/bounded_queue.h"
#include "net/midi/controls.h"
#include "net/midi/ports.h"

namespace limber::midi {

/// Bytes that have arrived; a longer message is in several.
struct MidiBytes {
  std::size_t device = 0;
  std::int64_t time = 0;  ///< ns
  std::uint8_t size = 0;
  std::array<std::uint8_t, 15> bytes{};
};

/// A port, or an input and an output of the same name.
struct Device {
  std::string name;
  std::unique_ptr<InputPort> input;
  std::unique_ptr<OutputPort> output;
  bool wants_input = false;
  bool wants_output = false;
  bool present = false;   ///< In the last list of ports.
  bool was_open = false;  ///< Since then.
  std::string fault;      ///< Reported reason why it can't be opened.
  MidiDecoder decoder;
  ControlReader reader;
};

class Devices {
 public:
  static constexpr std::int64_t kScanInterval = 1'000'000'000;  ///< ns
  static constexpr std::size_t kMaxDevices = 64;
  static constexpr std::size_t kMaxQueued = 8192;

  /// Which ports to open.
  struct Filter {
    bool controls = false;   ///< Ports of controllers.
    std::string name;        ///< Part of their name; empty: all, without ALSA's loop Midi Through.
    std::string clock_from;  ///< Part of the name of the port whose clock is followed; empty: none.
    std::string clock_to;    ///< The same of the port that gets a clock.
  };
  /// `now` returns the time in ns. `notify` is called after bytes have arrived; both from any thread.
  Devices(PortSystem& ports, Filter filter, std::function<std::int64_t()> now, std::function<void()> notify);

  /// Looks for devices, if it is time, and opens and closes ports. Returns true if any was opened or closed.
  bool scan(std::int64_t now);
  /// Closes all ports; the next scan() opens them again.
  void close();
  std::int64_t next_scan() const { return next_scan_; }
  /// Makes the next scan() look for devices.
  void scan_soon() { next_scan_ = 0; }
  /// Moves the bytes that have arrived into `out`.
  void drain(std::vector<MidiBytes>& out) { received_.drain(out); }
  /// Number of bytes' groups that were lost because too many arrived.
  std::uint64_t dropped() const { return received_.dropped(); }

  std::vector<Device>& list() { return devices_; }
  /// Whether its controls are used, its clock is followed, or it gets a clock.
  bool is_control(const Device& device) const;
  bool is_clock_source(const Device& device) const;
  bool is_clock_target(const Device& device) const;
  /// Why there are no ports; empty: there is a MIDI system.
  const std::string& problem() const { return problem_; }

 private:
  Device* find_or_add(const std::string& name);
  bool follow(Device& device, const PortNames& names) const;
  bool open(Device& device, std::size_t index);
  void report_missing();
  void receive(std::size_t device, std::span<const std::uint8_t> bytes);

  PortSystem& ports_;
  const Filter filter_;
  std::function<std::int64_t()> now_;
  std::function<void()> notify_;
  std::vector<Device> devices_;
  BoundedQueue<MidiBytes> received_{kMaxQueued};
  std::int64_t next_scan_ = 0;
  std::string problem_;
  bool reported_missing_ = false;
};

}  // namespace limber::midi
