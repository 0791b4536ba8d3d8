// LightingOutput: sockets and the loop of the thread.
#include "net/lighting/output.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/system/thread.h"
#include "base/system/wait.h"

namespace limber::lighting {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr int kNotOpened = -1;                        // Output::reported_error
constexpr std::int64_t kIdleInterval = kSecond / 20;  // between two looks at `armed`

Cid random_cid() {
  std::random_device device;
  Cid cid;
  for (std::uint8_t& each : cid) each = static_cast<std::uint8_t>(device());
  cid[6] = static_cast<std::uint8_t>((cid[6] & 0x0fU) | 0x40U);  // a random UUID
  cid[8] = static_cast<std::uint8_t>((cid[8] & 0x3fU) | 0x80U);
  return cid;
}

}  // namespace

LightingOutput::LightingOutput(engine::EngineLink& link, LightingOptions options)
    : link_(link), options_(std::move(options)), latch_(options_.lights, options_.in_real_time) {
  const Cid cid = random_cid();
  for (const LightTarget& target : options_.targets) {
    const std::size_t index = outputs_.size();
    outputs_.push_back(std::make_unique<Output>(
        target, cid,
        [this, index](const system::Endpoint& to, const std::string& packet) { send(*outputs_[index], to, packet); }));
  }
}

LightingOutput::~LightingOutput() { stop(); }

std::vector<std::string> LightingOutput::status_lines() const {
  std::vector<std::string> lines;
  for (const LightTarget& target : options_.targets) lines.push_back("lights " + target_text(target));
  return lines;
}

void LightingOutput::start() {
  if (outputs_.empty() || thread_.joinable()) return;
  std::string text;
  for (const std::string& line : status_lines()) text += fmt::format("{}{}", text.empty() ? "" : "\n", line);
  link_.lighting.set_text(text);
  for (const std::unique_ptr<Output>& output : outputs_) open(*output, system::clock_nanoseconds());
  stop_ = false;
  thread_ = std::thread([this] { run(); });
}

void LightingOutput::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  wake_.notify();
  thread_.join();
  link_.lighting.set(engine::LightingStatus::State::no_output);
}

Result<void> LightingOutput::open_target(Output& output) {
  const LightTarget& target = output.stream.target();
  if (target.protocol == Protocol::enttec) return output.serial.open(target.device);
  Result<system::UdpSocket> opened = system::open_udp({target.interface, 0});
  if (!opened)
    return Error{
        fmt::format("{}, from {}. Check interface=", opened.error(), system::endpoint_text({target.interface, 0}))};
  output.socket = std::move(*opened);
  system::allow_broadcast(output.socket.fd());
  system::send_multicast_from(output.socket.fd(), target.interface);
  return {};
}

void LightingOutput::open(Output& output, std::int64_t now) {
  if (output.is_open() || now < output.retry_at) return;
  output.retry_at = now + kSecond;
  const Result<void> opened = open_target(output);
  if (opened || std::exchange(output.reported_error, kNotOpened) != 0) return;
  log_warning("lights: {} can't be opened: {}; retrying every second", target_text(output.stream.target()),
              opened.error());
}

void LightingOutput::send(Output& output, const system::Endpoint& to, const std::string& packet) {
  if (!output.is_open()) return;
  int error = 0;
  if (output.serial.is_open()) {
    error = output.serial.send(packet);
  } else {
    error = system::send_datagram(output.socket.fd(), to, packet);
    if (error != 0 && system::may_report_earlier_datagram(error))
      error = system::send_datagram(output.socket.fd(), to, packet);
  }
  if (error == 0) link_.lighting.packets.fetch_add(1);
  report(output, error);
}

// Logs an error, and its end, once.
void LightingOutput::report(Output& output, int error) {
  const int before = std::exchange(output.reported_error, error);
  if (error == before) return;
  const std::string target = target_text(output.stream.target());
  if (error == 0) {
    log_info("lights: {} is sent again", target);
  } else if (output.stream.target().protocol == Protocol::enttec) {
    log_warning("lights: {} is gone: {}. Connect it again; retrying every second", target,
                std::generic_category().message(error));
  } else {
    log_warning("lights: {} can't be reached: {}. Check the address and the network; the output continues", target,
                std::generic_category().message(error));
  }
}

std::int64_t LightingOutput::send_due(std::int64_t now) {
  const std::shared_ptr<const engine::Snapshot> snapshot = link_.snapshots.read();
  if (snapshot == nullptr) return now + kIdleInterval;
  const sim::DmxFrame& frame = snapshot->dmx;
  const bool may_send = latch_.update(frame.armed, snapshot->replayed, snapshot->tick);
  using State = engine::LightingStatus::State;
  link_.lighting.set(may_send ? State::sending : frame.armed ? State::blocked : State::off);
  active_ = may_send;
  if (!may_send) {
    if (std::exchange(sends_, false)) {
      for (const std::unique_ptr<Output>& output : outputs_) output->stream.end();
    }
    return now + kIdleInterval;
  }
  sends_ = true;
  std::int64_t next = now + kSecond / 2;
  for (const std::unique_ptr<Output>& output : outputs_) {
    open(*output, now);
    if (const std::optional<std::int64_t> due = output->stream.update(frame, now)) next = std::min(next, *due);
  }
  return next;
}

void LightingOutput::wait_until(std::int64_t next) {
  std::vector<system::PollEntry> entries{{.fd = wake_.fd()}};
  for (const std::unique_ptr<Output>& output : outputs_) {
    if (output->serial.has_unsent()) entries.push_back({.fd = output->serial.fd(), .read = false, .write = true});
  }
  (void)system::wait_ready(entries,
                           std::chrono::nanoseconds(std::max<std::int64_t>(0, next - system::clock_nanoseconds())));
  for (const std::unique_ptr<Output>& output : outputs_) {
    if (!output->serial.has_unsent()) continue;
    if (const int error = output->serial.flush(); error != 0) report(*output, error);
  }
}

void LightingOutput::run() {
  system::name_this_thread("limber-lights");
  while (!stop_.load()) {
    wait_until(send_due(system::clock_nanoseconds()));
    wake_.clear();
  }
  if (std::exchange(sends_, false)) {
    for (const std::unique_ptr<Output>& output : outputs_) output->stream.end();
  }
  for (const std::unique_ptr<Output>& output : outputs_) output->serial.close();
}

}  // namespace limber::lighting
