// Feedback: sends the values of properties to motor faders, LED rings and the lights of buttons. [one thread]
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "net/midi/bindings.h"

namespace limber::midi {

/// Returns the bytes that show a value on a control; empty for kinds that can't show one.
std::vector<std::uint8_t> feedback_bytes(ControlKind kind, int channel, int number, int value);

/// A control gets a value when it differs from the one that the control has: the last that it has sent or got. A fader
/// that is being moved gets none, so that it doesn't work against the hand.
class Feedback {
 public:
  static constexpr std::int64_t kRestTime = 300'000'000;  ///< ns after the last movement of a fader.
  static constexpr std::int64_t kInterval = 33'000'000;   ///< ns between two updates.
  static constexpr std::size_t kMaxMessages = 16;         ///< Of an update, for slow cables: about 500 a second.
  /// Sends bytes to the device with this port.
  using Send = std::function<void(std::string_view port, std::span<const std::uint8_t> bytes)>;

  /// The map has changed, or devices were plugged in: all values are sent again.
  void reset() { known_.clear(); }
  /// A control of the port has moved.
  void note_movement(const Bindings& bindings, std::string_view port, const ControlEvent& event);
  /// Sends values that have changed. `ports`: the names of the ports. `now`: ns.
  void update(const Bindings& bindings, const std::vector<std::string>& ports, std::int64_t now, const Send& send);

 private:
  struct Known {
    std::size_t binding = 0;
    std::string port;
    int value = -1;
  };
  int& known(std::size_t binding, std::string_view port);

  std::vector<Known> known_;
  std::size_t next_ = 0;  // the binding to begin with, so that all get their turn
};

}  // namespace limber::midi
