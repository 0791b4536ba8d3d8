// Announcer: a child process for each port.
#include "app/service/announcer.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/system/file.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber::app {

namespace {

// True if the program has closed its output, so it has ended. Its text is discarded.
bool has_ended(const system::ChildProcess& process) {
  system::PollEntry entry{.fd = process.output()};
  std::array<char, 1024> text;
  while (system::wait_ready({&entry, 1}, std::chrono::nanoseconds(0))) {
    if (system::read_some(process.output(), text.data(), text.size()) <= 0) return true;
  }
  return false;
}

}  // namespace

void Announcer::update(const std::vector<AnnouncedPort>& ports) {
  std::erase_if(services_,
                [&](const Service& service) { return std::ranges::find(ports, service.port) == ports.end(); });
  for (const AnnouncedPort& port : ports) {
    if (std::ranges::find(services_, port, &Service::port) == services_.end()) services_.push_back({port, nullptr});
  }
  for (Service& service : services_) {
    if (service.process != nullptr && has_ended(*service.process)) {
      service.process.reset();
      report("it has ended; is the Avahi daemon running?");
    } else if (service.process == nullptr) {
      start(service);
    }
  }
}

void Announcer::start(Service& service) {
  service.process = std::make_unique<system::ChildProcess>();
  const int fault =
      service.process->start_quietly({program_, "-s", name_, service.port.type, fmt::format("{}", service.port.port)});
  if (fault == 0) return;
  service.process.reset();
  report(std::generic_category().message(fault));
}

void Announcer::report(const std::string& reason) {
  if (std::exchange(reported_, true)) return;
  log_warning("zeroconf: {} doesn't announce '{}': {}. Install the package avahi-utils; trying again every second",
              program_, printable(name_), reason);
}

}  // namespace limber::app
