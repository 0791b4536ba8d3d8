// The MIDI ports of the system, as an interface, so that tests replace them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace limber::midi {

/// An open port. Its destructor closes it.
class InputPort {
 public:
  InputPort() = default;
  virtual ~InputPort() = default;
  InputPort(const InputPort&) = delete;
  InputPort& operator=(const InputPort&) = delete;
};

class OutputPort {
 public:
  OutputPort() = default;
  virtual ~OutputPort() = default;
  OutputPort(const OutputPort&) = delete;
  OutputPort& operator=(const OutputPort&) = delete;
  /// Sends complete messages. Errors are ignored: the next list of ports shows that the device is gone.
  virtual void send(std::span<const std::uint8_t> bytes) = 0;
};

/// Names of the ports that exist, unique among inputs and among outputs. A device that is plugged in again has its
/// former name.
struct PortNames {
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
};

/// Functions return errors that name the cause; none throws. [one thread]
class PortSystem {
 public:
  /// Called with the bytes that arrive, on a thread of the system; must be brief.
  using Receiver = std::function<void(std::span<const std::uint8_t> bytes)>;

  PortSystem() = default;
  virtual ~PortSystem() = default;
  PortSystem(const PortSystem&) = delete;
  PortSystem& operator=(const PortSystem&) = delete;
  virtual Result<PortNames> list() = 0;
  virtual Result<std::unique_ptr<InputPort>> open_input(const std::string& name, Receiver receiver) = 0;
  virtual Result<std::unique_ptr<OutputPort>> open_output(const std::string& name) = 0;
};

/// Returns the ports of ALSA or JACK, by RtMidi.
std::unique_ptr<PortSystem> system_ports();

}  // namespace limber::midi
