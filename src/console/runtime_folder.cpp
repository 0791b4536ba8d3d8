// Folders, sockets and who may use them.
#include "console/runtime_folder.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kBegin = "limber-";
constexpr std::string_view kEnd = ".sock";
constexpr int kWaiting = 16;  // connections that may wait to be taken
constexpr int kMostWait = 2;  // seconds

std::string why(int error_number) { return std::generic_category().message(error_number); }

// what is wrong with a folder; empty: it is this user's alone
std::string folder_fault(const std::string& folder) {
  struct stat about {};
  if (lstat(folder.c_str(), &about) != 0) return why(errno);
  if (!S_ISDIR(about.st_mode)) return "it is no folder";
  if (about.st_uid != geteuid()) return "it belongs to somebody else";
  if ((about.st_mode & 077u) != 0) return fmt::format("others may look into it; chmod 700 {} mends that", folder);
  return {};
}

std::string temp_folder() {
  const char* temp = std::getenv("TMPDIR");
  return fmt::format("{}/limber-{}", temp != nullptr && temp[0] == '/' ? temp : "/tmp", geteuid());
}

// limber-123.sock: 123
std::optional<int> pid_of(std::string_view name) {
  if (!name.starts_with(kBegin) || !name.ends_with(kEnd)) return {};
  name = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  int pid = 0;
  const auto [end, fault] = std::from_chars(name.data(), name.data() + name.size(), pid);
  if (fault != std::errc{} || end != name.data() + name.size() || pid <= 0) return {};
  return pid;
}

Result<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return Error{
        fmt::format("{} is too long for a socket's path ({} bytes at most)", path, sizeof address.sun_path - 1)};
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

Descriptor open_socket() { return Descriptor(socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)); }

// connects, or gives the error's number
int connect_to(const Descriptor& socket, const sockaddr_un& address) {
  return connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
}

}  // namespace

std::vector<std::string> runtime_folders() {
  std::vector<std::string> folders;
  const auto add = [&](const std::string& folder) {
    if (folder.starts_with('/') && folder_fault(folder).empty() && std::ranges::count(folders, folder) == 0)
      folders.push_back(folder);
  };
  const char* named = std::getenv("XDG_RUNTIME_DIR");
  add(named != nullptr && named[0] == '/' ? named : fmt::format("/run/user/{}", geteuid()));
  add(temp_folder());
  return folders;
}

Result<std::string> make_runtime_folder() {
  if (std::vector<std::string> there = runtime_folders(); !there.empty()) return std::move(there.front());
  const std::string folder = temp_folder();
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    return Error{fmt::format("the folder {} can't be made: {}", folder, why(errno))};
  if (const std::string fault = folder_fault(folder); !fault.empty())
    return Error{fmt::format("the folder {} can't be used: {}", folder, fault)};
  return folder;
}

std::string socket_path(std::string_view folder, int pid) {
  return fmt::format("{}/{}{}{}", folder, kBegin, pid, kEnd);
}

std::vector<ConsoleSocket> console_sockets(const std::string& folder) {
  std::vector<ConsoleSocket> found;
  std::error_code fault;
  for (fs::directory_iterator at(folder, fault), end; !fault && at != end; at.increment(fault)) {
    const std::optional<int> pid = pid_of(at->path().filename().string());
    std::error_code ignored;
    if (!pid || !fs::is_socket(at->symlink_status(ignored))) continue;
    const std::string path = at->path().string();
    const Result<sockaddr_un> address = address_of(path);
    const Descriptor socket = open_socket();
    if (!address || !socket.open()) continue;
    const int refused = connect_to(socket, *address);
    if (refused == 0 || refused == EAGAIN) {
      found.push_back({*pid, path});
    } else if (refused == ECONNREFUSED) {
      unlink(path.c_str());
    }
  }
  std::ranges::sort(found, {}, &ConsoleSocket::pid);
  return found;
}

Result<Descriptor> connect_console(const std::string& path) {
  const Result<sockaddr_un> address = address_of(path);
  if (!address) return Error{address.error()};
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket.open()) return Error{why(errno)};
  // where many wait to be let in, it waits too, for a while
  const timeval most = {kMostWait, 0};
  setsockopt(socket.fd(), SOL_SOCKET, SO_SNDTIMEO, &most, sizeof most);
  if (const int refused = connect_to(socket, *address); refused != 0)
    return Error{fmt::format("{}: {}", path, why(refused))};
  fcntl(socket.fd(), F_SETFL, O_NONBLOCK);
  if (peer_user(socket) != static_cast<long>(geteuid()))
    return Error{fmt::format("{}: the program there belongs to somebody else", path)};
  return socket;
}

Result<Descriptor> listen_console(const std::string& path) {
  const std::string hidden = path + ".new";
  const Result<sockaddr_un> address = address_of(hidden);
  if (!address) return Error{address.error()};
  Descriptor socket = open_socket();
  if (!socket.open()) return Error{why(errno)};
  unlink(hidden.c_str());  // of an earlier program with our number
  const bool listens = bind(socket.fd(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) == 0 &&
                       chmod(hidden.c_str(), 0600) == 0 && listen(socket.fd(), kWaiting) == 0 &&
                       rename(hidden.c_str(), path.c_str()) == 0;
  if (listens) return socket;
  const std::string fault = why(errno);
  unlink(hidden.c_str());
  return Error{fmt::format("{}: {}", path, fault)};
}

long peer_user(const Descriptor& connection) {
  ucred who{};
  socklen_t length = sizeof who;
  if (getsockopt(connection.fd(), SOL_SOCKET, SO_PEERCRED, &who, &length) != 0) return -1;
  return static_cast<long>(who.uid);
}

}  // namespace limber
