// Announcer: announces the ports of a show by zeroconf (DNS-SD), with Avahi's program avahi-publish, so that tablets
// and other programs find it by name. [main]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/system/child_process.h"

namespace limber::app {

struct AnnouncedPort {
  std::string type;  ///< "_osc._udp"
  std::uint16_t port = 0;
  bool operator==(const AnnouncedPort&) const = default;
};

class Announcer {
 public:
  /// `name`: of the show. `program`: avahi-publish.
  explicit Announcer(std::string name, std::string program = "avahi-publish")
      : name_(std::move(name)), program_(std::move(program)) {}

  /// Announces these ports, and no others. Call it about once a second: it starts programs that have ended, which is
  /// reported once.
  void update(const std::vector<AnnouncedPort>& ports);

 private:
  struct Service {
    AnnouncedPort port;
    std::unique_ptr<system::ChildProcess> process;
  };
  void start(Service& service);
  void report(const std::string& reason);

  std::string name_;
  const std::string program_;
  std::vector<Service> services_;
  bool reported_ = false;
};

}  // namespace limber::app
