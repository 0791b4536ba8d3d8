// Serial ports of POSIX.
#include "base/system/serial_port.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/system/wait.h"

namespace limber::system {

namespace {

Error open_error() {
  const int reason = errno;
  const char* fix = "Connect the device, or check the name";
  if (reason == EACCES) fix = "Add the user to the group of the device: adduser USER dialout";
  if (reason == EBUSY) fix = "End the program that uses it";
  errno = reason;
  return Error{fmt::format("{}. {}", error_reason(), fix)};
}

// No conversion, no echo, no flow control, no waiting for a modem.
bool set_raw(int fd) {
  termios settings{};
  if (tcgetattr(fd, &settings) != 0) return false;
  cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB);
  settings.c_cflag |= static_cast<tcflag_t>(CLOCAL | CREAD);
  return cfsetispeed(&settings, B115200) == 0 && cfsetospeed(&settings, B115200) == 0 &&
         tcsetattr(fd, TCSANOW, &settings) == 0;
}

// Number of bytes that the device has not received yet; 0 if the system can't tell.
int unsent_bytes(int fd) {
  int count = 0;
  return ioctl(fd, TIOCOUTQ, &count) == 0 ? count : 0;
}

}  // namespace

Result<Descriptor> open_serial_port(const std::string& path) {
  Descriptor port(open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port.is_open()) return open_error();
  if (isatty(port.fd()) == 0) return Error{"it is not a serial port. Check the name"};
  if (flock(port.fd(), LOCK_EX | LOCK_NB) != 0) return Error{"another program uses it. End that program"};
  if (!set_raw(port.fd())) return open_error();
  (void)ioctl(port.fd(), TIOCEXCL);
  return port;
}

std::ptrdiff_t write_serial_port(int fd, std::string_view bytes) {
  const auto written = write(fd, bytes.data(), bytes.size());
  if (written >= 0) return written;
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? 0 : -1;
}

void close_serial_port(Descriptor port, std::chrono::milliseconds limit) {
  constexpr std::chrono::milliseconds kInterval{2};
  for (std::chrono::milliseconds waited{0}; unsent_bytes(port.fd()) > 0 && waited < limit; waited += kInterval)
    (void)wait_ready({}, kInterval);
  // otherwise, closing would wait for a device that receives nothing
  if (unsent_bytes(port.fd()) > 0) (void)tcflush(port.fd(), TCOFLUSH);
}

}  // namespace limber::system
