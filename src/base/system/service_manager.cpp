// Sends sd_notify messages through a Unix datagram socket.
#include "base/system/service_manager.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "base/system/net/socket_address.h"
#include "base/system/open.h"
#include "base/system/process.h"
#include "base/system/standard_output.h"
#include "base/text.h"

namespace limber::system {

namespace {

std::string consume_variable(const char* name) {
  const char* const value = std::getenv(name);
  std::string text = value == nullptr ? "" : value;
  unsetenv(name);
  return text;
}

}  // namespace

ServiceManager::ServiceManager() : address_(consume_variable("NOTIFY_SOCKET")) {
  const std::optional<double> limit = parse_number(consume_variable("WATCHDOG_USEC"));
  const std::string process = consume_variable("WATCHDOG_PID");
  sockaddr_un address{};
  const bool usable =
      address_.size() > 1 && (address_[0] == '/' || address_[0] == '@') && address_.size() < sizeof address.sun_path;
  if (!usable) return;
  socket_ = open_socket(AF_UNIX, SOCK_DGRAM);
  const bool mine = process.empty() || process == fmt::format("{}", process_id());
  if (limit && *limit >= 1 && *limit <= 1e15 && mine)
    watchdog_ = std::chrono::microseconds(static_cast<std::int64_t>(*limit));
}

bool ServiceManager::notify(std::string_view lines) const {
  if (!present()) return false;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, address_.data(), address_.size());
  const bool abstract = address_[0] == '@';
  if (abstract) address.sun_path[0] = '\0';
  const std::size_t length = offsetof(sockaddr_un, sun_path) + address_.size() + (abstract ? 0 : 1);
  return sendto(socket_.fd(), lines.data(), lines.size(), MSG_DONTWAIT | kNoSignal,
                reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(length)) >= 0;
}

bool standard_error_is_journal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat info {};
  if (stream == nullptr || fstat(kStandardError, &info) != 0) return false;
  return fmt::format("{}:{}", info.st_dev, info.st_ino) == stream;
}

}  // namespace limber::system
