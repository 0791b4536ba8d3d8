// Finding and checking runtime folders, listing their sockets.
#include "net/console/runtime_folder.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/system/net/local_socket.h"
#include "base/system/process.h"

namespace limber::console {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kSocketPrefix = "limber-";
constexpr std::string_view kSocketSuffix = ".sock";
constexpr int kConnectTimeout = 2;  // seconds

std::string error_text(int error_number) { return std::generic_category().message(error_number); }

// returns the reason why a folder is not private to this user; empty if it is
std::string folder_error(const std::string& folder) {
  const std::optional<system::FileStatus> status = system::link_status(folder);
  if (!status) return error_text(errno);
  if (!status->folder) return "it is not a folder";
  if (status->owner != system::user_id()) return "it belongs to another user";
  if ((status->permissions & 077u) != 0) return fmt::format("other users can access it; run chmod 700 {}", folder);
  return {};
}

std::string temp_folder() {
  const char* temp = std::getenv("TMPDIR");
  return fmt::format("{}/limber-{}", temp != nullptr && temp[0] == '/' ? temp : "/tmp", system::user_id());
}

// parses "limber-123.sock" as 123
std::optional<int> pid_of(std::string_view name) {
  if (!name.starts_with(kSocketPrefix) || !name.ends_with(kSocketSuffix)) return {};
  name = name.substr(kSocketPrefix.size(), name.size() - kSocketPrefix.size() - kSocketSuffix.size());
  int pid = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
  if (error != std::errc{} || end != name.data() + name.size() || pid <= 0) return {};
  return pid;
}

}  // namespace

std::vector<std::string> runtime_folders() {
  std::vector<std::string> folders;
  const auto add = [&](const std::string& folder) {
    if (folder.starts_with('/') && folder_error(folder).empty() && std::ranges::count(folders, folder) == 0)
      folders.push_back(folder);
  };
  const char* runtime_dir = std::getenv("XDG_RUNTIME_DIR");
  add(runtime_dir != nullptr && runtime_dir[0] == '/' ? runtime_dir : fmt::format("/run/user/{}", system::user_id()));
  add(temp_folder());
  return folders;
}

Result<std::string> make_runtime_folder() {
  if (std::vector<std::string> existing = runtime_folders(); !existing.empty()) return std::move(existing.front());
  const std::string folder = temp_folder();
  if (!system::make_folder(folder, 0700) && errno != EEXIST)
    return Error{fmt::format("the folder {} can't be created: {}", folder, error_text(errno))};
  if (const std::string error = folder_error(folder); !error.empty())
    return Error{fmt::format("the folder {} can't be used: {}", folder, error)};
  return folder;
}

std::string socket_path(std::string_view folder, int pid) {
  return fmt::format("{}/{}{}{}", folder, kSocketPrefix, pid, kSocketSuffix);
}

std::vector<ConsoleSocket> console_sockets(const std::string& folder) {
  std::vector<ConsoleSocket> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::optional<int> pid = pid_of(at->path().filename().string());
    std::error_code ignored;
    if (!pid || !fs::is_socket(at->symlink_status(ignored))) continue;
    const std::string path = at->path().string();
    const system::Listener listener = system::find_listener(path);
    if (listener == system::Listener::present) {
      found.push_back({*pid, path});
    } else if (listener == system::Listener::absent) {
      system::remove_file(path);
    }
  }
  std::ranges::sort(found, {}, &ConsoleSocket::pid);
  return found;
}

Result<system::Descriptor> connect_console(const std::string& path) {
  Result<system::Descriptor> socket = system::connect_local(path, kConnectTimeout);
  if (!socket) return socket;
  if (system::peer_user(*socket) != system::user_id())
    return Error{fmt::format("{}: the program belongs to another user", path)};
  return socket;
}

}  // namespace limber::console
