// MidiService: the order of the work, and the thread.
#include "net/midi/service.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber::midi {

namespace {

Devices::Filter filter_of(const MidiOptions& options) {
  return {true, options.ports, options.clock_from, options.clock_to};
}

std::string event_text(const ControlEvent& event, const std::string& device) {
  const std::string number = max_number(event.kind) > 0 ? fmt::format(" {}", event.number) : "";
  return fmt::format("{}{} = {}, channel {}, {}", control_kind_name(event.kind), number, event.value, event.channel,
                     device);
}

}  // namespace

MidiService::MidiService(engine::EngineLink& link, MidiOptions options, std::unique_ptr<PortSystem> ports,
                         std::function<std::int64_t()> now)
    : link_(link),
      options_(std::move(options)),
      ports_(std::move(ports)),
      now_(std::move(now)),
      devices_(*ports_, filter_of(options_), now_, [this] { wake_.notify(); }) {
  if (options_.use == MidiOptions::Use::off) return;
  link_.midi.set_available(true);
  link_.on_midi_request = [this](const Message& message, const CommandOrigin& origin) {
    requests_.push({message, origin});
    wake_.notify();
  };
}

MidiService::~MidiService() {
  stop();
  link_.on_midi_request = nullptr;
}

void MidiService::start() {
  if (options_.use == MidiOptions::Use::off || thread_.joinable()) return;
  stop_ = false;
  thread_ = std::thread([this] { run(); });
}

void MidiService::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  wake_.notify();
  thread_.join();
}

void MidiService::set_scene(const std::string& scene) {
  const std::scoped_lock lock(scene_mutex_);
  scene_ = scene;
  wake_.notify();
}

bool MidiService::is_on() const {
  return options_.use == MidiOptions::Use::on || options_.has_clock() || mapping_.needs_devices();
}

void MidiService::run() {
  system::name_this_thread("limber-midi");
  while (!stop_.load()) {
    const std::int64_t next = update();
    system::PollEntry entry{.fd = wake_.fd()};
    (void)system::wait_ready({&entry, 1}, std::chrono::nanoseconds(std::max<std::int64_t>(0, next - now_())));
    wake_.clear();
    // bytes wake it at once; the batches of a device that sends all the time have a distance. Pulses don't wait for it.
    const std::int64_t batch = times_.batch + kBatchInterval;
    const std::int64_t early = std::min(batch, next_pulse_.value_or(batch)) - now_();
    if (early > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(early));
  }
  clocks_.stop(devices_);
  devices_.close();
}

std::int64_t MidiService::update() {
  const std::int64_t now = now_();
  handle_requests();
  mapping_.poll_file(now);
  if (is_on()) {
    scan_devices(now);
    read_values(now);
    accept_bytes();
    push_messages(now);
    finish_learning(now);
    send_feedback(now);
    next_pulse_ = options_.clock_to.empty() ? std::nullopt : clocks_.send_due(devices_, now);
  } else {
    devices_.close();
  }
  publish(now);
  return next_time(now);
}

void MidiService::handle_requests() {
  std::optional<std::string> scene;
  {
    const std::scoped_lock lock(scene_mutex_);
    scene = std::exchange(scene_, std::nullopt);
  }
  if (scene) mapping_.open(*scene);
  std::vector<Request> requests;
  requests_.drain(requests);
  for (const Request& request : requests) handle(request);
}

void MidiService::handle(const Request& request) {
  const bool learns = same_address(request.message.address, "/midi/learn");
  const Result<std::string> done =
      learns ? mapping_.learn(request.message.args) : mapping_.forget(request.message.args);
  if (!done) return fail(request.origin, request.message.address, done.error());
  if (learns) learn_origin_ = request.origin;
  if (learns && !done->empty()) {
    log_info("MIDI: move the control for {}", *done);
    devices_.scan_soon();
  }
  link_.push_out({engine::Outgoing::Destination::reply,
                  request.origin,
                  {learns ? "/midi/learning" : "/midi/forgotten", {Arg::of(std::string_view(*done))}}});
}

void MidiService::finish_learning(std::int64_t now) {
  const std::string address = mapping_.learner().request() ? mapping_.learner().request()->address : "";
  const std::optional<Result<std::string>> done = mapping_.finish_learning(now);
  if (!done) return;
  if (!*done) return fail(learn_origin_, "/midi/learn", done->error());
  log_info("MIDI: {} sets {}", **done, address);
  link_.push_out({engine::Outgoing::Destination::reply,
                  learn_origin_,
                  {"/midi/learned", {Arg::of(std::string_view(address)), Arg::of(std::string_view(**done))}}});
}

void MidiService::fail(const CommandOrigin& to, std::string_view address, const std::string& text) {
  log_warning("{}: {}", address, text);
  link_.push_out({engine::Outgoing::Destination::error, to, engine::error_message(address, text)});
}

void MidiService::scan_devices(std::int64_t now) {
  std::vector<std::string> open;
  for (const Device& device : devices_.list()) {
    if (device.input != nullptr) open.push_back(device.name);
  }
  if (!devices_.scan(now)) return;
  mapping_.reset_feedback();
  clocks_.restart();
  for (const Device& device : devices_.list()) {
    const bool lost = device.input == nullptr && std::ranges::find(open, device.name) != open.end();
    if (lost) mapping_.release(device.name, now);
  }
}

void MidiService::accept_bytes() {
  devices_.drain(received_);
  for (const MidiBytes& part : received_) {
    Device& device = devices_.list()[part.device];
    device.decoder.decode({part.bytes.data(), part.size},
                          [&](const MidiMessage& message) { accept_message(device, message, part.time); });
  }
}

void MidiService::accept_message(Device& device, const MidiMessage& message, std::int64_t time) {
  if (devices_.is_clock_source(device)) clocks_.accept(message, time);
  if (!devices_.is_control(device)) return;
  bool first = true;  // a control change is the first interpretation, of which a parameter is the more specific one
  device.reader.accept(message, [&](const ControlEvent& event) {
    const bool is_parameter = event.kind == ControlKind::nrpn || event.kind == ControlKind::rpn;
    if (std::exchange(first, false) || is_parameter) last_event_ = event_text(event, device.name);
    mapping_.accept(device.name, event, time);
    if (time - times_.moved > kGestureGap) gesture_ = static_cast<std::uint16_t>(gesture_ % 0xfffeU + 1);
    times_.moved = time;
  });
}

// Queues the messages of a batch. Returns the request of a value snapshot that contains their effect; 0: they were
// lost.
std::uint64_t MidiService::push(std::vector<Message> messages, std::uint16_t gesture) {
  engine::Command command;
  command.messages = std::move(messages);
  command.origin = {CommandSource::midi, 0, gesture, false};
  const bool pushed = link_.command_queue.push(std::move(command));
  if (!pushed) return 0;
  return link_.request_value_snapshot();
}

void MidiService::push_messages(std::int64_t now) {
  if (std::vector<Message> clock = clocks_.drain(now); !clock.empty()) (void)push(std::move(clock), 0);
  std::vector<Message> messages = mapping_.bindings().drain();
  times_.batch = now;
  if (!messages.empty()) mapping_.bindings().note_sent(push(std::move(messages), gesture_));
}

// Reads the newest values, and requests the next ones.
void MidiService::read_values(std::int64_t now) {
  const std::shared_ptr<const engine::ValueSnapshot> snapshot = link_.value_snapshots.read();
  if (snapshot != nullptr) mapping_.update(snapshot);
  if (!options_.clock_to.empty()) {
    if (const std::shared_ptr<const engine::Snapshot> tick = link_.snapshots.read()) clocks_.update(*tick, now);
    times_.clock = now + kClockInterval;
  }
  if (now < times_.values) return;
  times_.values = now + Feedback::kInterval;
  if (mapping_.needs_devices()) (void)link_.request_value_snapshot();
}

void MidiService::send_feedback(std::int64_t now) {
  if (now < times_.feedback) return;
  times_.feedback = now + Feedback::kInterval;
  std::vector<std::string> ports;
  for (const Device& device : devices_.list()) {
    if (device.output != nullptr && devices_.is_control(device)) ports.push_back(device.name);
  }
  mapping_.send_feedback(ports, now, [this](std::string_view port, std::span<const std::uint8_t> bytes) {
    const auto found = std::ranges::find(devices_.list(), port, &Device::name);
    if (found != devices_.list().end() && found->output != nullptr) found->output->send(bytes);
  });
}

std::int64_t MidiService::next_time(std::int64_t now) const {
  if (!is_on()) return now + kIdleInterval;
  std::int64_t next = std::min(now + kIdleInterval, devices_.next_scan());
  if (mapping_.needs_devices()) next = std::min(next, times_.feedback);
  if (const std::optional<std::int64_t> due = mapping_.learner().due()) next = std::min(next, *due);
  if (!options_.clock_to.empty()) next = std::min(next, times_.clock);
  if (next_pulse_) next = std::min(next, *next_pulse_);
  return next;
}

void MidiService::publish(std::int64_t now) {
  if (now < times_.status) return;
  times_.status = now + kStatusInterval;
  engine::MidiReport report;
  report.on = is_on();
  report.problem = devices_.problem();
  for (const Device& device : devices_.list()) {
    if (device.was_open)
      report.devices.push_back({device.name, device.present, device.input != nullptr, device.output != nullptr});
  }
  mapping_.report(report);
  report.last_event = last_event_;
  link_.midi.set(std::move(report));
}

}  // namespace limber::midi
