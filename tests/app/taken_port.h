// A local port, chosen by the system, that is in use.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>

namespace limber::app::test {

class PortInUse {
 public:
  /// SOCK_DGRAM or SOCK_STREAM.
  explicit PortInUse(int kind) : fd_(socket(AF_INET, kind | SOCK_CLOEXEC, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&at), size) == 0)
      getsockname(fd_, reinterpret_cast<sockaddr*>(&at), &size);
    if (kind == SOCK_STREAM) listen(fd_, 1);
    number_ = ntohs(at.sin_port);
  }
  ~PortInUse() { close(fd_); }
  PortInUse(const PortInUse&) = delete;
  PortInUse& operator=(const PortInUse&) = delete;
  std::string port() const { return std::to_string(number_); }

 private:
  int fd_;
  std::uint16_t number_ = 0;
};

}  // namespace limber::app::test
