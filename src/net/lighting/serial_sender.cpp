// SerialSender: queue of one packet.
#include "net/lighting/serial_sender.h"

#include <cerrno>
#include <chrono>
#include <utility>

#include "base/system/devices/serial_port.h"
#include "base/system/wait.h"

namespace limber::lighting {

namespace {

constexpr std::chrono::milliseconds kCloseLimit{100};

}  // namespace

Result<void> SerialSender::open(const std::string& device) {
  Result<system::Descriptor> port = system::open_serial_port(device);
  if (!port) return Error{port.error()};
  port_ = std::move(*port);
  begun_.clear();
  next_.clear();
  return {};
}

int SerialSender::send(const std::string& packet) {
  next_ = packet;
  return flush();
}

int SerialSender::flush() {
  while (port_.is_open() && has_unsent()) {
    if (begun_.empty()) begun_ = std::exchange(next_, {});
    const std::ptrdiff_t written = system::write_serial_port(port_.fd(), begun_);
    if (written < 0) {
      const int reason = errno;
      port_ = {};
      begun_.clear();
      next_.clear();
      return reason;
    }
    if (written == 0) break;
    begun_.erase(0, static_cast<std::size_t>(written));
  }
  return 0;
}

void SerialSender::close() {
  if (!port_.is_open()) return;
  if (has_unsent()) {
    system::PollEntry entry{.fd = port_.fd(), .read = false, .write = true};
    if (system::wait_ready({&entry, 1}, kCloseLimit)) (void)flush();
  }
  system::close_serial_port(std::exchange(port_, {}), kCloseLimit);
}

}  // namespace limber::lighting
