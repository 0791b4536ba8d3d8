// The ports of the system by RtMidi, which throws and prints: its errors are caught, or reach a callback.
#include <algorithm>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <RtMidi.h>
#include <fmt/format.h>

#include "base/system/net/midi_system.h"
#include "base/text.h"
#include "net/midi/ports.h"

namespace limber::midi {

namespace {

constexpr const char* kClientName = "Limber";

// Notes the last error; without a callback RtMidi would print it.
void note_error(RtMidiError::Type type, const std::string& text, void* to) {
  if (type != RtMidiError::DEBUG_WARNING) *static_cast<std::string*>(to) = text;
}

// Calls a function that may throw. Returns the text of its error.
template <class F>
std::optional<std::string> fault_of(F&& function) {
  try {
    function();
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown error";
  }
  return std::nullopt;
}

// "nanoKONTROL2:nanoKONTROL2 MIDI 1 20:0": ALSA appends the numbers of client and port, which change when the device is
// plugged in again.
std::string without_numbers(const std::string& name) {
  const std::size_t space = name.find_last_of(' ');
  const std::size_t colon = space == std::string::npos ? space : name.find(':', space);
  if (colon == std::string::npos) return name;
  const auto digits = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const std::string_view all = name;
  const bool numbered = digits(all.substr(space + 1, colon - space - 1)) && digits(all.substr(colon + 1));
  return numbered ? name.substr(0, space) : name;
}

// Names of the ports with their numbers, without our own ones. The second of two equal names gets " #2".
template <class Port>
std::map<std::string, unsigned> named_ports(Port& port) {
  std::map<std::string, unsigned> named;
  const unsigned count = port.getPortCount();
  for (unsigned i = 0; i < count; i++) {
    const std::string name = printable(without_numbers(port.getPortName(i)));
    if (name.empty() || name.starts_with(kClientName)) continue;
    std::string unique = name;
    for (int n = 2; named.contains(unique); n++) unique = fmt::format("{} #{}", name, n);
    named.emplace(std::move(unique), i);
  }
  return named;
}

class RtInput final : public InputPort {
 public:
  RtInput(RtMidi::Api api, PortSystem::Receiver receiver) : receiver_(std::move(receiver)), port_(api, kClientName) {
    port_.setErrorCallback(note_error, &error_);
    port_.ignoreTypes(true, false, true);
    port_.setCallback(&RtInput::receive, this);
  }
  RtMidiIn& port() { return port_; }
  std::string& error() { return error_; }

 private:
  static void receive(double, std::vector<unsigned char>* bytes, void* self) {
    if (bytes != nullptr) static_cast<RtInput*>(self)->receiver_({bytes->data(), bytes->size()});
  }

  PortSystem::Receiver receiver_;
  std::string error_;
  RtMidiIn port_;  // the last member: closed before those that its thread uses
};

class RtOutput final : public OutputPort {
 public:
  explicit RtOutput(RtMidi::Api api) : port_(api, kClientName) { port_.setErrorCallback(note_error, &error_); }
  RtMidiOut& port() { return port_; }
  std::string& error() { return error_; }
  void send(std::span<const std::uint8_t> bytes) override {
    (void)fault_of([&] { port_.sendMessage(bytes.data(), bytes.size()); });
  }

 private:
  std::string error_;
  RtMidiOut port_;
};

class RtPorts final : public PortSystem {
 public:
  Result<PortNames> list() override {
    if (Result<void> connected = connect(); !connected) return Error{connected.error()};
    PortNames names;
    const std::optional<std::string> fault = fault_of([&] {
      for (const auto& [name, number] : named_ports(in_->port())) names.inputs.push_back(name);
      for (const auto& [name, number] : named_ports(out_->port())) names.outputs.push_back(name);
    });
    if (!fault) return names;
    disconnect();
    return Error{*fault};
  }

  Result<std::unique_ptr<InputPort>> open_input(const std::string& name, Receiver receiver) override {
    std::unique_ptr<RtInput> input;
    const Result<void> opened =
        open(name, [&] { return &(input = std::make_unique<RtInput>(api_, std::move(receiver)))->port(); });
    if (!opened) return Error{opened.error()};
    if (!input->port().isPortOpen()) return Error{input->error()};
    return std::unique_ptr<InputPort>(std::move(input));
  }

  Result<std::unique_ptr<OutputPort>> open_output(const std::string& name) override {
    std::unique_ptr<RtOutput> output;
    const Result<void> opened = open(name, [&] { return &(output = std::make_unique<RtOutput>(api_))->port(); });
    if (!opened) return Error{opened.error()};
    if (!output->port().isPortOpen()) return Error{output->error()};
    return std::unique_ptr<OutputPort>(std::move(output));
  }

 private:
  // Opens the clients that list the ports, if the system has MIDI at all.
  Result<void> connect() {
    if (in_ != nullptr && out_ != nullptr) return {};
    const system::MidiSystem found = system::find_midi_system();
    if (found == system::MidiSystem::none)
      return Error{
          "this machine has neither the ALSA sequencer nor a JACK server. Load it with 'modprobe snd-seq', add "
          "yourself to the group audio, or start JACK"};
    api_ = found == system::MidiSystem::alsa   ? RtMidi::LINUX_ALSA
           : found == system::MidiSystem::jack ? RtMidi::UNIX_JACK
                                               : RtMidi::UNSPECIFIED;
    const std::optional<std::string> fault = fault_of([&] {
      in_ = std::make_unique<RtInput>(api_, [](std::span<const std::uint8_t>) {});
      out_ = std::make_unique<RtOutput>(api_);
    });
    if (!fault) return {};
    disconnect();
    return Error{*fault};
  }

  void disconnect() {
    in_.reset();
    out_.reset();
  }

  // Opens the port of that name with the client that `make` returns.
  template <class Make>
  Result<void> open(const std::string& name, Make make) {
    bool found = false;
    const std::optional<std::string> fault = fault_of([&] {
      auto* const port = make();
      const std::map<std::string, unsigned> ports = named_ports(*port);
      const auto at = ports.find(name);
      found = at != ports.end();
      if (found) port->openPort(at->second, kClientName);
    });
    if (fault) return Error{*fault};
    return found ? Result<void>() : Error{"it is gone"};
  }

  RtMidi::Api api_ = RtMidi::UNSPECIFIED;
  std::unique_ptr<RtInput> in_;
  std::unique_ptr<RtOutput> out_;
};

}  // namespace

std::unique_ptr<PortSystem> system_ports() { return std::make_unique<RtPorts>(); }

}  // namespace limber::midi
