// MIDI ports without devices, for tests: devices are plugged in and moved by calls.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "net/midi/ports.h"

namespace limber::midi::test {

using Bytes = std::vector<std::uint8_t>;

/// The devices, which a test keeps while the service owns FakePorts.
struct FakeDevices {
  PortNames names;
  std::map<std::string, PortSystem::Receiver> receivers;  ///< Of open inputs.
  std::map<std::string, int> open_outputs;
  std::vector<std::pair<std::string, Bytes>> sent;  ///< In order: port and bytes.
  std::string fault;                                ///< Of the system.
  std::map<std::string, std::string> faults;        ///< Of single ports.
  int lists = 0;                                    ///< Number of looks at the ports.

  void plug_in(const std::string& name, bool output = true) {
    names.inputs.push_back(name);
    if (output) names.outputs.push_back(name);
  }
  void unplug(const std::string& name) {
    std::erase(names.inputs, name);
    std::erase(names.outputs, name);
  }
  /// The device sends bytes. False if its input isn't open.
  bool send(const std::string& name, const Bytes& bytes) {
    const auto found = receivers.find(name);
    if (found == receivers.end()) return false;
    found->second(bytes);
    return true;
  }
  /// Returns the bytes that a device has got since the last call.
  Bytes received(const std::string& name) {
    Bytes all;
    for (const auto& [port, bytes] : sent) {
      if (port == name) all.insert(all.end(), bytes.begin(), bytes.end());
    }
    std::erase_if(sent, [&](const auto& each) { return each.first == name; });
    return all;
  }
};

class FakePorts final : public PortSystem {
 public:
  explicit FakePorts(FakeDevices& devices) : devices_(devices) {}

  Result<PortNames> list() override {
    devices_.lists++;
    if (!devices_.fault.empty()) return Error{devices_.fault};
    return devices_.names;
  }
  Result<std::unique_ptr<InputPort>> open_input(const std::string& name, Receiver receiver) override {
    if (devices_.faults.contains(name)) return Error{devices_.faults[name]};
    devices_.receivers[name] = std::move(receiver);
    return std::unique_ptr<InputPort>(std::make_unique<Input>(devices_, name));
  }
  Result<std::unique_ptr<OutputPort>> open_output(const std::string& name) override {
    if (devices_.faults.contains(name)) return Error{devices_.faults[name]};
    return std::unique_ptr<OutputPort>(std::make_unique<Output>(devices_, name));
  }

 private:
  struct Input final : InputPort {
    Input(FakeDevices& all, std::string port) : devices(all), name(std::move(port)) {}
    ~Input() override { devices.receivers.erase(name); }
    FakeDevices& devices;
    std::string name;
  };
  struct Output final : OutputPort {
    Output(FakeDevices& all, std::string port) : devices(all), name(std::move(port)) { devices.open_outputs[name]++; }
    ~Output() override { devices.open_outputs[name]--; }
    void send(std::span<const std::uint8_t> bytes) override {
      devices.sent.emplace_back(name, Bytes(bytes.begin(), bytes.end()));
    }
    FakeDevices& devices;
    std::string name;
  };

  FakeDevices& devices_;
};

}  // namespace limber::midi::test
