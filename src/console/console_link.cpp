// Connecting, and lines out and in.
#include "console/console_link.h"

#include <cerrno>

#include <fmt/format.h>

#include "base/system/socket.h"
#include "base/system/wait.h"

namespace limber {

namespace {

constexpr int kHelloMs = 2000;  // a program that says nothing for so long is not well

std::string list_text(const std::vector<RunningProgram>& programs) {
  std::string text;
  for (const RunningProgram& each : programs)
    text += fmt::format("\n  limber console {}    {}", each.socket.pid, each.scene);
  return text;
}

// false: nothing came. Signals that are blocked otherwise come in here: none gets lost between two looks
bool wait_for_some(int fd, int wait_ms) {
  system::Waiting waiting{.fd = fd};
  std::optional<std::chrono::nanoseconds> limit;
  if (wait_ms >= 0) limit = std::chrono::milliseconds(wait_ms);
  return system::wait_ready_or_signal({&waiting, 1}, limit);
}

// connects and reads the first line
Result<ConsoleLink> greet(const std::string& path, ConsoleLine& hello) {
  Result<system::Descriptor> connection = connect_console(path);
  if (!connection) return Error{connection.error()};
  ConsoleLink link(std::move(*connection));
  const std::optional<ConsoleLine> first = link.next(kHelloMs);
  if (!first) return Error{fmt::format("{}: nothing answers there", path)};
  if (first->kind == ConsoleLine::Kind::refused) return Error{first->text};
  if (first->kind != ConsoleLine::Kind::hello) return Error{fmt::format("{}: that is no limber", path)};
  hello = *first;
  return link;
}

}  // namespace

bool ConsoleLink::send(const ConsoleRequest& request) {
  const std::string line = request_line(request);
  for (std::size_t sent = 0; sent < line.size();) {
    const std::ptrdiff_t n = system::send_bytes(fd(), std::string_view(line).substr(sent));
    if (n > 0) {
      sent += static_cast<std::size_t>(n);
    } else if (errno == EAGAIN) {
      system::Waiting waiting{.fd = fd(), .read = false, .write = true};
      (void)system::wait_ready({&waiting, 1}, std::nullopt);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

std::optional<ConsoleLine> ConsoleLink::take_line() {
  while (true) {
    const std::size_t end = in_.find('\n');
    if (end == std::string::npos) return {};
    Result<ConsoleLine> line = parse_line(std::string_view(in_).substr(0, end));
    in_.erase(0, end + 1);
    // a newer program may say more than this console knows
    if (line) return std::move(*line);
  }
}

// false: nothing is there to read now
bool ConsoleLink::read_some() {
  char bytes[16384];
  const std::ptrdiff_t got = system::receive_bytes(fd(), bytes, sizeof bytes);
  if (got > 0) {
    in_.append(bytes, static_cast<std::size_t>(got));
    return true;
  }
  if (got == 0 || (errno != EAGAIN && errno != EINTR)) ended_ = true;
  return false;
}

std::optional<ConsoleLine> ConsoleLink::next(int wait_ms) {
  while (true) {
    if (std::optional<ConsoleLine> line = take_line()) return line;
    if (ended_) return {};
    if (read_some()) continue;
    if (ended_) return {};
    if (!wait_for_some(fd(), wait_ms)) return {};
  }
}

std::vector<RunningProgram> running_programs() {
  std::vector<RunningProgram> programs;
  for (const std::string& folder : runtime_folders()) {
    for (ConsoleSocket& socket : console_sockets(folder)) {
      ConsoleLine hello;
      const Result<ConsoleLink> link = greet(socket.path, hello);
      programs.push_back({std::move(socket), link ? hello.text : link.error()});
    }
  }
  return programs;
}

Result<ConsoleLink> choose_program(int pid, ConsoleLine& hello) {
  std::vector<RunningProgram> programs = running_programs();
  if (programs.empty()) {
    return Error{"no limber of yours is running; start one with `limber play`, without --fast, first"};
  }
  if (pid == 0 && programs.size() > 1)
    return Error{fmt::format("{} of your programs are running; choose one:{}", programs.size(), list_text(programs))};
  for (const RunningProgram& each : programs) {
    if (pid == 0 || each.socket.pid == pid) return greet(each.socket.path, hello);
  }
  return Error{fmt::format("no limber of yours has the number {}; there are:{}", pid, list_text(programs))};
}

}  // namespace limber
