// Devices: hot-plug.
#include "net/midi/devices.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "net/midi/map.h"

namespace limber::midi {

namespace {

constexpr std::string_view kLoop = "Midi Through";  // of ALSA: sends everything back

bool contains_name(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

Devices::Devices(PortSystem& ports, Filter filter, std::function<std::int64_t()> now, std::function<void()> notify)
    : ports_(ports), filter_(std::move(filter)), now_(std::move(now)), notify_(std::move(notify)) {}

bool Devices::is_control(const Device& device) const {
  if (!filter_.controls) return false;
  return filter_.name.empty() ? !port_matches(device.name, kLoop) : port_matches(device.name, filter_.name);
}

bool Devices::is_clock_source(const Device& device) const {
  return !filter_.clock_from.empty() && port_matches(device.name, filter_.clock_from);
}

bool Devices::is_clock_target(const Device& device) const {
  return !filter_.clock_to.empty() && port_matches(device.name, filter_.clock_to);
}

Device* Devices::find_or_add(const std::string& name) {
  const auto found = std::ranges::find(devices_, name, &Device::name);
  if (found != devices_.end()) return &*found;
  if (devices_.size() >= kMaxDevices) return nullptr;
  Device& device = devices_.emplace_back();
  device.name = name;
  return &device;
}

bool Devices::scan(std::int64_t now) {
  if (now < next_scan_) return false;
  next_scan_ = now + kScanInterval;
  Result<PortNames> names = ports_.list();
  const std::string problem = names ? "" : names.error();
  if (problem != std::exchange(problem_, problem) && !problem.empty())
    log_warning("MIDI is not available: {}. Limber plays on, and looks for it every second", problem);
  if (!names) names = PortNames{};
  for (const std::vector<std::string>* each : {&names->inputs, &names->outputs}) {
    for (const std::string& name : *each) (void)find_or_add(name);
  }
  bool changed = false;
  for (std::size_t i = 0; i < devices_.size(); i++) {
    changed |= follow(devices_[i], *names);
    changed |= open(devices_[i], i);
  }
  report_missing();
  return changed;
}

// Closes the ports of a device that no longer exist. Returns true if it was unplugged.
bool Devices::follow(Device& device, const PortNames& names) const {
  const bool has_input = contains_name(names.inputs, device.name);
  const bool has_output = contains_name(names.outputs, device.name);
  const bool was_open = device.input != nullptr || device.output != nullptr;
  device.present = has_input || has_output;
  if (!has_input) device.input.reset();
  if (!has_output) device.output.reset();
  device.wants_input = has_input && (is_control(device) || is_clock_source(device));
  device.wants_output = has_output && (is_control(device) || is_clock_target(device));
  if (!was_open || device.present) return false;
  log_warning("MIDI: {} was unplugged. It is opened again when it returns", device.name);
  return true;
}

void Devices::close() {
  for (Device& device : devices_) {
    device.input.reset();
    device.output.reset();
    device.was_open = false;
  }
  next_scan_ = 0;
}

// Opens the ports of a device that are wanted. Returns true if one was opened.
bool Devices::open(Device& device, std::size_t index) {
  std::string fault;
  bool opened = false;
  if (device.wants_input && device.input == nullptr) {
    auto input =
        ports_.open_input(device.name, [this, index](std::span<const std::uint8_t> bytes) { receive(index, bytes); });
    if (input) {
      device.input = std::move(*input);
      device.decoder = {};
      device.reader = {};
      opened = true;
    } else {
      fault = input.error();
    }
  }
  if (device.wants_output && device.output == nullptr) {
    auto output = ports_.open_output(device.name);
    if (output) {
      device.output = std::move(*output);
      opened = true;
    } else {
      fault = output.error();
    }
  }
  if (!fault.empty() && fault != device.fault)
    log_warning("MIDI: {} can't be opened: {}. Close other programs that use it; retrying every second", device.name,
                fault);
  device.fault = fault;
  if (!opened) return false;
  log_info("MIDI: {} {}", device.name, device.was_open ? "is back" : "is open");
  device.was_open = true;
  return true;
}

// A name that matches nothing is reported once.
void Devices::report_missing() {
  if (!problem_.empty()) return;
  std::string missing;
  for (const std::string* part : {&filter_.name, &filter_.clock_from, &filter_.clock_to}) {
    const bool found = std::ranges::any_of(devices_, [&](const Device& d) { return port_matches(d.name, *part); });
    if (!part->empty() && !found) missing = *part;
  }
  if (missing.empty() || std::exchange(reported_missing_, true)) return;
  std::string names;
  for (const Device& device : devices_) names += fmt::format("{}{}", names.empty() ? "" : ", ", device.name);
  log_warning("MIDI: no port has '{}' in its name; there are: {}. It is opened as soon as it is plugged in", missing,
              names.empty() ? "none" : names);
}

void Devices::receive(std::size_t device, std::span<const std::uint8_t> bytes) {
  const std::int64_t now = now_();
  constexpr std::size_t kLongest = 256;  // a message of a control is much shorter
  bytes = bytes.first(std::min(bytes.size(), kLongest));
  while (!bytes.empty()) {
    MidiBytes part{device, now};
    part.size = static_cast<std::uint8_t>(std::min(bytes.size(), part.bytes.size()));
    std::copy_n(bytes.begin(), part.size, part.bytes.begin());
    received_.push(part);
    bytes = bytes.subspan(part.size);
  }
  notify_();
}

}  // namespace limber::midi
